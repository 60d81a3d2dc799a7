/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "xml.h"

#include <libxml/parser.h>
#include <stdlib.h>
#include <string.h>

#include "formats/core/core.h"

enum {
    PATH_MAX_BYTES = 512,
    TEXT_MAX_BYTES = 8192,
    DIGITS_MOST = 15
};

struct rc_xml {
    xmlParserCtxtPtr parser;
    const char *name;
    rc_element *element;
    void *arg;
    struct rc_err err; /* the error for which this file stopped the parser */
    bool stopped, attributes;
    size_t path_length, below; /* below: number of levels that did not fit into the path */
    size_t text_length;
    char path[PATH_MAX_BYTES];
    char text[TEXT_MAX_BYTES];
};

static void
stop(struct rc_xml *x)
{
    x->stopped = true;
    xmlStopParser(x->parser);
}

/* Attribute k of an element in the layout of libxml2. It has five pointers, with the value between the last
 * two. */
static void
on_attribute(struct rc_xml *x, const xmlChar *const *attribute)
{
    const char *name = (const char *)attribute[0];
    size_t n = (size_t)(attribute[4] - attribute[3]), length = strlen(name);

    if (x->stopped || x->path_length + 2 + length >= sizeof x->path)
        return;
    n = n < sizeof x->text ? n : sizeof x->text - 1;
    memcpy(x->text, attribute[3], n);
    x->text[n] = '\0';
    x->path[x->path_length] = '/';
    x->path[x->path_length + 1] = '@';
    memcpy(x->path + x->path_length + 2, name, length + 1);
    if (x->element(x->arg, x->path, x->text, &x->err) != RC_OK)
        stop(x);
    x->path[x->path_length] = '\0';
}

static void
on_start(void *arg, const xmlChar *name, const xmlChar *prefix, const xmlChar *uri, int spaces,
         const xmlChar **space, int attributes, int defaulted, const xmlChar **attribute)
{
    struct rc_xml *x = arg;
    size_t n = strlen((const char *)name);

    (void)prefix, (void)uri, (void)spaces, (void)space;
    (void)defaulted;
    x->text_length = 0;
    if (x->below > 0 || x->path_length + 1 + n >= sizeof x->path) {
        x->below++;
        return;
    }
    if (x->path_length > 0)
        x->path[x->path_length++] = '/';
    memcpy(x->path + x->path_length, name, n + 1);
    x->path_length += n;
    for (int k = 0; x->attributes && k < attributes; k++)
        on_attribute(x, (const xmlChar *const *)attribute + 5 * k);
}

static void
on_text(void *arg, const xmlChar *text, int length)
{
    struct rc_xml *x = arg;
    size_t left = sizeof x->text - 1 - x->text_length;
    size_t n = (size_t)length < left ? (size_t)length : left;

    memcpy(x->text + x->text_length, text, n);
    x->text_length += n;
}

static void
on_end(void *arg, const xmlChar *name, const xmlChar *prefix, const xmlChar *uri)
{
    struct rc_xml *x = arg;
    const char *text = x->text;
    size_t n = x->text_length;
    char *slash;

    (void)name, (void)prefix, (void)uri;
    x->text_length = 0;
    if (x->below > 0) {
        x->below--;
        return;
    }
    rc_trim(&text, &n);
    x->text[(size_t)(text - x->text) + n] = '\0';
    if (!x->stopped && x->element(x->arg, x->path, text, &x->err) != RC_OK)
        stop(x);
    slash = strrchr(x->path, '/');
    x->path_length = slash == NULL ? 0 : (size_t)(slash - x->path);
    x->path[x->path_length] = '\0';
}

/* Called at the name of a document type, before its content is read. */
static void
on_document_type(void *arg, const xmlChar *name, const xmlChar *external, const xmlChar *system)
{
    struct rc_xml *x = arg;

    (void)name, (void)external, (void)system;
    if (x->stopped)
        return;
    rc_err_set(
        &x->err,
        "%s has a document type declaration, which can hide expanding entities: it is not read",
        x->name);
    stop(x);
}

static void
on_complaint(void *arg, xmlErrorPtr complaint)
{
    (void)arg, (void)complaint; /* feed requests the last one */
}

struct rc_xml *
rc_xml_new(const char *name, bool attributes, rc_element *element, void *arg, struct rc_err *err)
{
    xmlSAXHandler handlers = {
        .initialized = XML_SAX2_MAGIC,
        .startElementNs = on_start,
        .endElementNs = on_end,
        .characters = on_text,
        .cdataBlock = on_text,
        .internalSubset = on_document_type,
        .serror = on_complaint,
    };
    struct rc_xml *x = calloc(1, sizeof *x);

    if (x != NULL) {
        x->name = name;
        x->attributes = attributes;
        x->element = element;
        x->arg = arg;
        x->parser = xmlCreatePushParserCtxt(&handlers, x, NULL, 0, NULL);
    }
    if (x == NULL || x->parser == NULL) {
        rc_err_set(err, "out of memory for reading XML");
        free(x);
        return NULL;
    }
    xmlCtxtUseOptions(x->parser, XML_PARSE_NONET);
    return x;
}

static enum rc_status
feed(struct rc_xml *x, const unsigned char *bytes, size_t n, int last, struct rc_err *err)
{
    const xmlError *why;
    char said[RC_SHOWN * 2];

    if (xmlParseChunk(x->parser, (const char *)bytes, (int)n, last) == 0 && !x->stopped)
        return RC_OK;
    if (x->stopped)
        return rc_err_set(err, "%s", x->err.text);
    why = xmlCtxtGetLastError(x->parser);
    if (why == NULL || why->message == NULL)
        return rc_err_set(err, "%s is no XML", x->name);
    rc_text_clean(said, sizeof said, why->message, strlen(why->message));
    return rc_err_set(err, "%s is not well-formed XML: line %d: %s", x->name, why->line, said);
}

enum rc_status
rc_xml_feed(struct rc_xml *x, const unsigned char *bytes, size_t n, struct rc_err *err)
{
    return feed(x, bytes, n, 0, err);
}

enum rc_status
rc_xml_end(struct rc_xml *x, struct rc_err *err)
{
    return feed(x, NULL, 0, 1, err);
}

void
rc_xml_free(struct rc_xml *x)
{
    if (x == NULL)
        return;
    if (x->parser->myDoc != NULL)
        xmlFreeDoc(x->parser->myDoc);
    xmlFreeParserCtxt(x->parser);
    free(x);
}

enum rc_status
rc_xml_read(const char *name, const unsigned char *bytes, size_t n, rc_element *element, void *arg,
            struct rc_err *err)
{
    RC_OWN(rc_xml, x) = rc_xml_new(name, false, element, arg, err);

    return x != NULL && rc_xml_feed(x, bytes, n, err) == RC_OK ? rc_xml_end(x, err) : RC_FAIL;
}

/* ---- numbers in attributes and text ---- */

enum rc_status
rc_xml_number(const char *document, const char *name, const char *text, double *value,
              struct rc_err *err)
{
    const char *end = rc_number_read(text, true, value);

    if (end != NULL && *end == '\0')
        return RC_OK;
    return rc_err_set(err, "%s is '%s' in %s: that is not a number", name, rc_word_shown(text),
                      document);
}

enum rc_status
rc_xml_whole(const char *document, const char *name, const char *text, size_t *value,
             struct rc_err *err)
{
    if (*text == '\0' || strlen(text) > DIGITS_MOST || text[strspn(text, "0123456789")] != '\0')
        return rc_err_set(err, "%s is '%s' in %s: it must be a whole number", name,
                          rc_word_shown(text), document);
    *value = strtoul(text, NULL, 10);
    return RC_OK;
}
