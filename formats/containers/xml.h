/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * XML read in pieces, without a tree; only this file uses libxml2. Nothing is fetched, no entity is expanded
 * and a document type declaration is refused, so that the text is never larger than the document.
 */
#ifndef RC_XML_H
#define RC_XML_H

#include <stddef.h>

#include "libcontact/owned.h"

struct rc_xml;

/* Called at the end of every element. `path` has the names from the root on, without namespaces:
 * "ISO5436_2/Record1/FeatureType". `text` is the trimmed text of the element: complete if the element
 * contains no others, cut at 8 KiB. */
typedef enum rc_status rc_element(void *arg, const char *path, const char *text,
                                  struct rc_err *err);

/* `name` is the name of the document in messages. `attributes`: `element` is called for attributes too, at
 * the beginning of their element: "row/c/@r" and the value. */
struct rc_xml *rc_xml_new(const char *name, bool attributes, rc_element *element, void *arg,
                          struct rc_err *err);
/* Parses the next n bytes of the document. */
enum rc_status rc_xml_feed(struct rc_xml *xml, const unsigned char *bytes, size_t n,
                           struct rc_err *err);
/* Ends the document: RC_FAIL if it is incomplete. */
enum rc_status rc_xml_end(struct rc_xml *xml, struct rc_err *err);
void rc_xml_free(struct rc_xml *xml); /* NULL is allowed */
RC_OWNER(rc_xml)

/* Parses a whole document of n bytes. */
enum rc_status rc_xml_read(const char *name, const unsigned char *bytes, size_t n,
                           rc_element *element, void *arg, struct rc_err *err);

/* The text of an element as a number, also "nan" and "inf"; RC_FAIL for other text. `name` is the name of the
 * element in messages, `document` that of the document. */
enum rc_status rc_xml_number(const char *document, const char *name, const char *text,
                             double *value, struct rc_err *err);
/* The same for a whole number, of at most 15 digits. */
enum rc_status rc_xml_whole(const char *document, const char *name, const char *text, size_t *value,
                            struct rc_err *err);

#endif
