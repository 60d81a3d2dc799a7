/*
 * XML read in pieces, without a tree; the only place that knows libxml2.
 *
 * Nothing is fetched, no entity is expanded and a document type declaration is refused, so that
 * what is read is never larger than what was given.
 */
#ifndef RC_XML_H
#define RC_XML_H

#include <stddef.h>

#include "libcontact/grid.h"

struct rc_xml;

/* Called at the end of every element. `path` holds the names from the root on, without namespaces:
 * "ISO5436_2/Record1/FeatureType"; `text` is what stands in it, trimmed: all of it where the
 * element holds no others, cut at 8 KiB. */
typedef enum rc_status rc_element(void *arg, const char *path, const char *text,
                                  struct rc_err *err);

/* `name` is the document's, for messages. `attributes`: call `element` for them too, where their element
 * begins: "row/c/@r" and the value. */
struct rc_xml *rc_xml_new(const char *name, bool attributes, rc_element *element, void *arg,
                          struct rc_err *err);
/* The next n bytes of the document. */
enum rc_status rc_xml_feed(struct rc_xml *xml, const unsigned char *bytes, size_t n,
                           struct rc_err *err);
/* There are no more: RC_FAIL when the document is not whole. */
enum rc_status rc_xml_end(struct rc_xml *xml, struct rc_err *err);
void rc_xml_free(struct rc_xml *xml); /* NULL is allowed */

/* The whole of a document of n bytes. */
enum rc_status rc_xml_read(const char *name, const unsigned char *bytes, size_t n,
                           rc_element *element, void *arg, struct rc_err *err);

/* An element's text that must be a number, "nan" and "inf" among them; RC_FAIL says so. `name` is
 * what the element is called in messages, `document` where it stands. */
enum rc_status rc_xml_number(const char *document, const char *name, const char *text,
                             double *value, struct rc_err *err);
/* The same for a whole number, of at most 15 digits. */
enum rc_status rc_xml_whole(const char *document, const char *name, const char *text, size_t *value,
                            struct rc_err *err);

#endif
