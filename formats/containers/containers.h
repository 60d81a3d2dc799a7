/*
 * The face of this folder: what files are packed in or laid out by, whatever format they are of. Each
 * library for such a thing is known to one or two files here.
 */
#ifndef RC_CONTAINERS_H
#define RC_CONTAINERS_H

#include "cdf.h"
#include "checksum.h"
#include "gzip.h"
#include "hdf.h"
#include "tiff.h"
#include "xml.h"
#include "zip_read.h"
#include "zip_write.h"

#endif
