/* SPDX-License-Identifier: GPL-3.0-or-later */
/* HDF5 in memory; only these files and writers/hdf5.c use libhdf5. Use it in the sandbox (sandbox.h): damaged
 * files make the library crash, loop or allocate without limit. */
#ifndef RC_HDF_H
#define RC_HDF_H

#include <stddef.h>

#include "formats/core/core.h"
#include "libcontact/owned.h"

struct rc_hdf;

struct rc_hdf *rc_hdf_new(const struct rc_file *file, struct rc_err *err);
void rc_hdf_free(struct rc_hdf *hdf); /* NULL is allowed */
RC_OWNER(rc_hdf)

/* A dataset of numbers with two dimensions, besides leading ones of length 1. */
struct rc_hdf_set {
    char path[256];
    size_t rows, columns;
};
/* Searches the file in the order of names: returns the number of datasets, and the first `most` of them. */
size_t rc_hdf_sets(struct rc_hdf *hdf, struct rc_hdf_set *set, size_t most);
/* The dataset at a path; false if there is none. */
bool rc_hdf_set_at(struct rc_hdf *hdf, const char *path, struct rc_hdf_set *set);
enum rc_status rc_hdf_values(struct rc_hdf *hdf, const struct rc_hdf_set *set, double *v,
                             struct rc_err *err);

/* An attribute of a dataset, as a number (the first of several) or as text. */
bool rc_hdf_number(struct rc_hdf *hdf, const char *path, const char *name, double *value);
char *rc_hdf_text(struct rc_hdf *hdf, const char *path, const char *name, char *to, size_t size);

/* A record of a table, which is a dataset or an attribute of compounds. It has the texts of its first text
 * members, and the numbers of its first member that is a list of numbers. */
struct rc_hdf_record {
    char text[3][128];
    double number[4];
    size_t numbers;
};
typedef void rc_hdf_take_record(void *arg, const struct rc_hdf_record *record);
/* `attribute` NULL: the dataset itself. False when there is no such table. */
bool rc_hdf_table(struct rc_hdf *hdf, const char *path, const char *attribute,
                  rc_hdf_take_record *take, void *arg);

/* True if it begins like an HDF5 file. */
bool rc_hdf_is(const struct rc_file *file);

#endif
