/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "relief.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "page.h"
#include "raster.h"
#include "ticks.h"

/* The coordinates of the box, divided by the longer side of the map. X is to the right and Y upwards in the
 * picture of the map, Z towards its viewer. The origin is the middle of the floor. */
struct vec {
    double x, y, z;
};

struct scene {
    const struct figure *f;
    const struct view *view;
    struct page *page;
    double lx, ly, lz;            /* lx and ly and lz of the box */
    struct vec right, up, toward; /* direction towards the viewer, in the box                */
    double scale, ox, oy;         /* pixels per unit, and the position of the origin */
    double left, top;             /* size of the image, pixels                               */
    size_t nx, ny;                /* corners of the mesh                                     */
    double *value;                /* value of each corner, NaN: none */
    size_t w, h, fine;            /* the image, with `fine` samples along each side of a pixel */
    float *depth;                 /* distance towards the viewer of the nearest surface so far */
    struct rgb *colour;
};

/* A corner of a triangle on the image. */
struct corner {
    double x, y, depth, value, shade;
};

static const struct rgb wall = {0xc4, 0xc4, 0xc4}, edge = {0x99, 0x99, 0x99};

static struct scene *
scene_of(const struct page *p)
{
    return p->of;
}

/* ---- the box and its projection ---- */

static double
dot(struct vec a, struct vec b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double
longer_side(const struct figure *f)
{
    return fmax(f->at.right - f->at.left, f->at.bottom - f->at.top);
}

double
relief_exaggeration(const struct figure *f)
{
    double most = 0.4 * longer_side(f) / (f->bar.hi - f->bar.lo),
           power = pow(10, floor(log10(most)));

    if (f->at.exaggeration > 0)
        return f->at.exaggeration;
    return (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1) * power;
}

bool
relief_to_scale(const struct figure *f)
{
    return strcmp(f->bar.unit, "m") == 0 && (f->at.dunit == NULL || strcmp(f->at.dunit, "m") == 0);
}

static void
set_view(struct scene *s)
{
    double az = s->view->azimuth * FIGURE_PI / 180, el = s->view->elevation * FIGURE_PI / 180;
    double side = longer_side(s->f);

    s->lx = (s->f->at.right - s->f->at.left) / side;
    s->ly = (s->f->at.bottom - s->f->at.top) / side;
    s->lz = relief_to_scale(s->f) ? relief_exaggeration(s->f) * (s->f->bar.hi - s->f->bar.lo) / side
                                  : 0.35;
    s->right = (struct vec){cos(az), sin(az), 0};
    s->toward = (struct vec){cos(el) * sin(az), -cos(el) * cos(az), sin(el)};
    s->up = (struct vec){-sin(el) * sin(az), sin(el) * cos(az), cos(el)};
}

static double
height_of(const struct scene *s, double value)
{
    double t = (value - s->f->bar.lo) / (s->f->bar.hi - s->f->bar.lo);

    return s->lz * fmin(fmax(t, 0), 1);
}

static void
project(const struct scene *s, struct vec v, double *x, double *y)
{
    *x = s->ox + s->scale * dot(v, s->right);
    *y = s->oy - s->scale * dot(v, s->up);
}

/* Corner k of the box: its bits mean right, back (up the map), top. */
static struct vec
box_corner(const struct scene *s, int k)
{
    return (struct vec){(k & 1 ? 0.5 : -0.5) * s->lx, (k & 2 ? 0.5 : -0.5) * s->ly,
                        k & 4 ? s->lz : 0};
}

/* ---- the mesh ---- */

static enum rc_status
set_mesh(struct scene *s, const struct rc_grid *g, struct rc_err *err)
{
    RC_OWN(raster, r) = NULL;

    s->nx = g->nx < RELIEF_SIDE ? g->nx : RELIEF_SIDE;
    s->ny = g->ny < RELIEF_SIDE ? g->ny : RELIEF_SIDE;
    r = (s->view->peaks ? raster_rows_max : raster_rows)(g, false, s->nx, s->ny, 0, s->ny, err);
    if (r == NULL)
        return RC_FAIL;
    s->value = r->v;
    r->v = NULL;
    for (size_t k = 0; k < s->nx * s->ny; k++)
        if (!isfinite(s->value[k]))
            s->value[k] = NAN;
    return RC_OK;
}

static struct vec
node_at(const struct scene *s, size_t i, size_t j)
{
    return (struct vec){(((double)i + 0.5) / (double)s->nx - 0.5) * s->lx,
                        -(((double)j + 0.5) / (double)s->ny - 0.5) * s->ly,
                        height_of(s, s->value[j * s->nx + i])};
}

/* Slope of the surface from valid neighbours, along a row or a column. */
static double
slope(const struct scene *s, size_t i, size_t j, bool along)
{
    size_t at = along ? i : j, n = along ? s->nx : s->ny, a = at > 0 ? at - 1 : at,
           b = at + 1 < n ? at + 1 : at;
    struct vec p = along ? node_at(s, a, j) : node_at(s, i, a), q;

    if (isnan(p.z))
        p = node_at(s, i, j);
    q = along ? node_at(s, b, j) : node_at(s, i, b);
    if (isnan(q.z))
        q = node_at(s, i, j);
    if (along)
        return q.x > p.x ? (q.z - p.z) / (q.x - p.x) : 0;
    return q.y < p.y ? (q.z - p.z) / (q.y - p.y) : 0;
}

/* The light comes over the left shoulder of the viewer. */
static double
light_on(const struct scene *s, struct vec normal)
{
    double lit =
        (-0.55 * dot(normal, s->right) + 0.45 * dot(normal, s->up) + 0.7 * dot(normal, s->toward)) /
        sqrt(dot(normal, normal));

    return 0.35 + 0.7 * fmax(lit, 0);
}

/* Flat parts have the colours of the bar. */
static double
shade_of(const struct scene *s, struct vec normal)
{
    return fmin(light_on(s, normal) / light_on(s, (struct vec){0, 0, 1}), 1.25);
}

static struct corner
corner_at(const struct scene *s, struct vec v, double value, double shade)
{
    struct corner c = {.depth = dot(v, s->toward), .value = value, .shade = shade};

    project(s, v, &c.x, &c.y);
    c.x = (c.x - s->left) * (double)s->fine;
    c.y = (c.y - s->top) * (double)s->fine;
    return c;
}

static struct corner
node_corner(const struct scene *s, size_t i, size_t j)
{
    double value = s->value[j * s->nx + i];
    struct vec normal = {0, 0, 1};

    if (isnan(value))
        return (struct corner){.value = NAN};
    normal.x = -slope(s, i, j, true);
    normal.y = -slope(s, i, j, false);
    return corner_at(s, node_at(s, i, j), value, shade_of(s, normal));
}

/* ---- pixels ---- */

static unsigned char
lit(unsigned char c, double shade)
{
    return (unsigned char)fmin(255, c * shade + 0.5);
}

static void
put(struct scene *s, size_t at, double depth, struct rgb colour, double shade)
{
    if (!((float)depth > s->depth[at]))
        return;
    s->depth[at] = (float)depth;
    s->colour[at] = (struct rgb){lit(colour.r, shade), lit(colour.g, shade), lit(colour.b, shade)};
}

static struct rgb
surface_colour(const struct scene *s, double value)
{
    if (s->f->nodes.zero_is_none && value == 0)
        return s->f->bar.map->none;
    return colormap_at(s->f->bar.map, figure_place(s->f, value));
}

/* Fills the triangle where it is nearer than the surface drawn before. It has one colour or, with NULL, the
 * colours of the values between its corners. */
static void
triangle(struct scene *s, const struct corner *a, const struct corner *b, const struct corner *c,
         const struct rgb *own)
{
    double area = (b->x - a->x) * (c->y - a->y) - (c->x - a->x) * (b->y - a->y);
    double x0 = fmax(fmin(fmin(a->x, b->x), c->x), 0), y0 = fmax(fmin(fmin(a->y, b->y), c->y), 0);
    double x1 = fmin(fmax(fmax(a->x, b->x), c->x), (double)s->w);
    double y1 = fmin(fmax(fmax(a->y, b->y), c->y), (double)s->h);

    if (fabs(area) < 1e-12)
        return;
    for (size_t y = (size_t)y0; (double)y < y1; y++)
        for (size_t x = (size_t)x0; (double)x < x1; x++) {
            double px = (double)x + 0.5, py = (double)y + 0.5;
            double u = ((b->x - px) * (c->y - py) - (c->x - px) * (b->y - py)) / area;
            double v = ((c->x - px) * (a->y - py) - (a->x - px) * (c->y - py)) / area;
            double t = 1 - u - v;

            if (u < -1e-9 || v < -1e-9 || t < -1e-9)
                continue;
            put(s, y * s->w + x, u * a->depth + v * b->depth + t * c->depth,
                own != NULL ? *own : surface_colour(s, u * a->value + v * b->value + t * c->value),
                u * a->shade + v * b->shade + t * c->shade);
        }
}

/* Two triangles; if one corner is missing, only the other one. */
static void
quad(struct scene *s, const struct corner *const q[4])
{
    for (int k = 0; k < 2; k++) {
        int skip = -1, missing = 0;

        for (int m = 0; m < 4; m++)
            if (isnan(q[m]->value)) {
                skip = m;
                missing++;
            }
        if (missing > 1 || (missing == 1 && k == 1))
            return;
        if (missing == 1)
            triangle(s, q[(skip + 1) % 4], q[(skip + 2) % 4], q[(skip + 3) % 4], NULL);
        else
            triangle(s, q[0], q[1 + k], q[2 + k], NULL);
    }
}

static enum rc_status
draw_surface(struct scene *s, struct rc_err *err)
{
    RC_OWNED struct corner *row = malloc(2 * s->nx * sizeof *row);

    if (row == NULL)
        return rc_err_set(err, "out of memory for a relief");
    for (size_t j = 0; j < s->ny; j++) {
        struct corner *here = row + j % 2 * s->nx, *last = row + (j + 1) % 2 * s->nx;

        for (size_t i = 0; i < s->nx; i++)
            here[i] = node_corner(s, i, j);
        for (size_t i = 0; j > 0 && i + 1 < s->nx; i++)
            quad(s,
                 (const struct corner *const[4]){&last[i], &last[i + 1], &here[i + 1], &here[i]});
    }
    return RC_OK;
}

/* A wall from the edge of the surface down to the floor, between two nodes of that edge. */
static void
draw_wall(struct scene *s, size_t i, size_t j, size_t k, size_t l, struct vec outwards)
{
    struct vec a = node_at(s, i, j), b = node_at(s, k, l);
    double shade = 0.6 + 0.4 * light_on(s, outwards);
    struct corner q[4];

    if (isnan(a.z) || isnan(b.z))
        return;
    q[0] = corner_at(s, a, 0, shade);
    q[1] = corner_at(s, b, 0, shade);
    a.z = b.z = 0;
    q[2] = corner_at(s, b, 0, shade);
    q[3] = corner_at(s, a, 0, shade);
    triangle(s, &q[0], &q[1], &q[2], &wall);
    triangle(s, &q[0], &q[2], &q[3], &wall);
}

static void
draw_walls(struct scene *s)
{
    for (size_t i = 0; i + 1 < s->nx; i++) {
        draw_wall(s, i, 0, i + 1, 0, (struct vec){0, 1, 0});
        draw_wall(s, i, s->ny - 1, i + 1, s->ny - 1, (struct vec){0, -1, 0});
    }
    for (size_t j = 0; j + 1 < s->ny; j++) {
        draw_wall(s, 0, j, 0, j + 1, (struct vec){-1, 0, 0});
        draw_wall(s, s->nx - 1, j, s->nx - 1, j + 1, (struct vec){1, 0, 0});
    }
}

/* The mean of the samples of pixel (x, y), over white; false without any. */
static bool
mean_at(const struct scene *s, size_t x, size_t y, struct rgb *mean)
{
    size_t n = s->fine, covered = 0;
    double sum[3] = {0, 0, 0}, all = (double)(n * n);

    for (size_t k = 0; k < n * n; k++) {
        size_t at = (y * n + k / n) * s->w + x * n + k % n;
        bool is = s->depth[at] > -INFINITY;

        covered += is;
        sum[0] += is ? s->colour[at].r : 255;
        sum[1] += is ? s->colour[at].g : 255;
        sum[2] += is ? s->colour[at].b : 255;
    }
    *mean = (struct rgb){(unsigned char)(sum[0] / all + 0.5), (unsigned char)(sum[1] / all + 0.5),
                         (unsigned char)(sum[2] / all + 0.5)};
    return covered > 0;
}

static void
put_image(struct scene *s)
{
    size_t across = s->w / s->fine, down = s->h / s->fine, n = across * down;
    struct rgb *pixel = malloc(n * sizeof *pixel);
    bool *inked = malloc(n * sizeof *inked);

    if (inked == NULL) {
        free(pixel);
        pixel = NULL;
    }
    for (size_t k = 0; k < n && pixel != NULL; k++)
        inked[k] = mean_at(s, k % across, k / across, &pixel[k]);
    canvas_image(s->page->c, s->left, s->top, (double)across, (double)down, pixel, inked, across,
                 down);
}

static enum rc_status
draw_image(struct scene *s, struct rc_err *err)
{
    size_t across = (size_t)s->page->plot.w, down = (size_t)s->page->plot.h;
    RC_OWNED float *depth = NULL;
    RC_OWNED struct rgb *colour = NULL;

    s->left = s->page->plot.x;
    s->top = s->page->plot.y;
    s->fine = across * down < 5000000 ? 2 : 1;
    s->w = across * s->fine;
    s->h = down * s->fine;
    s->depth = depth = malloc(s->w * s->h * sizeof *s->depth);
    s->colour = colour = malloc(s->w * s->h * sizeof *s->colour);
    if (s->depth == NULL || s->colour == NULL)
        return rc_err_set(err, "out of memory for a relief of %zu by %zu pixels", across, down);
    for (size_t k = 0; k < s->w * s->h; k++)
        s->depth[k] = -INFINITY;
    draw_walls(s);
    if (draw_surface(s, err) != RC_OK)
        return RC_FAIL;
    put_image(s);
    return RC_OK;
}

/* ---- axes on the edges of the box ---- */

static void
line(struct scene *s, struct vec a, struct vec b, double width, struct rgb colour)
{
    double x, y;

    project(s, a, &x, &y);
    canvas_move(s->page->c, x, y);
    project(s, b, &x, &y);
    canvas_draw_to(s->page->c, x, y);
    canvas_stroke(s->page->c, width, colour);
}

/* The edges that end in the nearest corner of the top are omitted, so that no line crosses the surface. */
static void
draw_box(struct scene *s)
{
    static const int edges[12][2] = {{0, 1}, {2, 3}, {0, 2}, {1, 3}, {4, 5}, {6, 7},
                                     {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
    int near_side = (s->right.y > 0 ? 1 : 0) | (s->right.x >= 0 ? 0 : 2);

    for (int k = 0; k < 12; k++) {
        int a = edges[k][0], b = edges[k][1];

        if (b == (near_side | 4) || a == (near_side | 4))
            continue;
        line(s, box_corner(s, a), box_corner(s, b), fmax(1, s->page->u), edge);
    }
}

/* An axis from corner a to corner b; marks point in the direction `out` of the picture. */
struct side {
    const struct axis *axis;
    struct vec a, b;
    double out[2];
    bool flip;     /* values decrease from a to b */
    bool keep_off; /* no number at the nearest corner: another axis has one there */
};

/* The widest number of all axes. */
static double
widest_number(const struct page *p)
{
    return fmax(p->values.widest, fmax(p->across.widest, p->down.widest));
}

static void
draw_side(struct scene *s, const struct side *side)
{
    const struct axis *a = side->axis;
    struct page *p = s->page;
    double u = p->u, x0, y0, x1, y1, length, widest = 0;
    struct ticks ticks;
    char text[TICKS_TEXT];

    project(s, side->a, &x0, &y0);
    project(s, side->b, &x1, &y1);
    length = hypot(x1 - x0, y1 - y0);
    if (length < 40 * u)
        return; /* seen end on */
    line(s, side->a, side->b, 1.6 * u, page_ink);
    ticks_choose(&ticks, a->lo, a->hi,
                 fmin(8, fmax(2, length / ((side->out[1] > 0 ? 3.4 : 1.8) * p->font.small.size))));
    for (long long k = ticks.first; k <= ticks.last; k++) {
        double t = axis_place(a, ticks_at(&ticks, k)), x, y, part;

        t = side->flip ? 1 - t : t;
        x = x0 + t * (x1 - x0);
        y = y0 + t * (y1 - y0);
        canvas_line(p->c, x, y, x + 9 * u * side->out[0], y + 9 * u * side->out[1]);
        canvas_stroke(p->c, 1.6 * u, page_ink);
        part = 0.5 - 0.5 * fmin(fmax(1.6 * side->out[0], -1), 1);
        ticks_text_to(text, &ticks, k);
        if (side->keep_off &&
            hypot(x - (t < 0.5 ? x0 : x1), y - (t < 0.5 ? y0 : y1)) < 1.6 * p->font.small.size &&
            (t < 0.5) == (y0 > y1))
            continue;
        widest = fmax(widest, canvas_text_width(p->c, &p->font.small, text));
        canvas_text(p->c, &p->font.small, x + 15 * u * side->out[0],
                    y + 15 * u * side->out[1] + (0.36 + 0.42 * side->out[1]) * p->font.small.size,
                    part, text);
    }
    if (fabs(x1 - x0) < 0.02 * length) {
        if (canvas_text_width(p->c, &p->font.large, a->label) > length - p->font.small.size)
            widest = widest_number(p); /* it extends downwards beside a mark of the floor */
        canvas_text_upwards(p->c, &p->font.large, x0 - widest - 26 * u, 0.5 * (y0 + y1), a->label);
    } else {
        double far = 24 * u + fabs(side->out[0]) * widest + fabs(side->out[1]) * p->font.small.size;
        double part = 0.5 - 0.5 * fmin(fmax(1.6 * side->out[0], -1), 1);

        canvas_text(p->c, &p->font.large, 0.5 * (x0 + x1) + far * side->out[0],
                    0.5 * (y0 + y1) + far * side->out[1] + 0.8 * p->font.large.size * side->out[1],
                    part, a->label);
    }
}

/* The direction away from the box in the picture, for an edge of the floor with the outer normal `n`. */
static void
set_out(const struct scene *s, struct side *side, struct vec n)
{
    double x = dot(n, s->right), y = -dot(n, s->up), length;

    y = fmax(y, 0.35); /* below the edge, also if the floor is seen from the side */
    length = hypot(x, y);
    side->out[0] = x / length;
    side->out[1] = y / length;
}

/* The edges of the floor nearest to the viewer, and the leftmost vertical edge of the box. */
static void
set_sides(const struct scene *s, struct side side[3])
{
    double fx = s->right.y > 0 ? 0.5 * s->lx : -0.5 * s->lx;
    double fy = s->right.x >= 0 ? -0.5 * s->ly : 0.5 * s->ly;
    struct vec a = {-fx, fy, 0}, b = {fx, -fy, 0}, left;

    left = dot(a, s->right) < dot(b, s->right) ? a : b;
    side[0] = (struct side){
        .axis = &s->page->across, .a = {-0.5 * s->lx, fy, 0}, .b = {0.5 * s->lx, fy, 0}};
    side[1] = (struct side){.axis = &s->page->down,
                            .a = {fx, -0.5 * s->ly, 0},
                            .b = {fx, 0.5 * s->ly, 0},
                            .flip = true,
                            .keep_off = true};
    side[2] = (struct side){
        .axis = &s->page->values, .a = left, .b = {left.x, left.y, s->lz}, .out = {-1, 0}};
    set_out(s, &side[0], (struct vec){0, fy, 0});
    set_out(s, &side[1], (struct vec){fx, 0, 0});
}

/* The height of marks and labels of the floor's edges below the box. */
static double
below_box(const struct scene *s)
{
    const struct page *p = s->page;
    double below = 18 * p->u + 1.3 * p->font.small.size, bottom = (p->plot.y + p->plot.h);
    struct side side[3];

    set_sides(s, side);
    for (int k = 0; k < 2; k++) {
        double x[2], y[2];

        project(s, side[k].a, &x[0], &y[0]);
        project(s, side[k].b, &x[1], &y[1]);
        below = fmax(below, 0.5 * (y[0] + y[1]) - bottom + 30 * p->u +
                                side[k].out[1] * (p->font.small.size + 1.2 * p->font.large.size));
    }
    return below;
}

/* ---- the whole ---- */

/* The part of the picture that a box of scale 1 takes, from its origin. */
static struct box
box_extent(struct scene *s)
{
    double x0 = INFINITY, x1 = -INFINITY, y0 = INFINITY, y1 = -INFINITY;

    s->scale = 1;
    s->ox = s->oy = 0;
    for (int k = 0; k < 8; k++) {
        double x, y;

        project(s, box_corner(s, k), &x, &y);
        x0 = fmin(x0, x);
        x1 = fmax(x1, x);
        y0 = fmin(y0, y);
        y1 = fmax(y1, y);
    }
    return (struct box){x0, y0, x1 - x0, y1 - y0};
}

/* Makes the box as large as fits beside the bar. */
static enum rc_status
lay_out(struct page *p, struct rc_err *err)
{
    const double least = 150; /* units of the design: on a smaller width marks touch each other */
    struct scene *s = scene_of(p);
    const struct box box = box_extent(s);
    double u = p->u;

    p->plot.w = p->plot.h = floor(600 * u);
    page_measure(p);
    p->space.left = 24 * u + 1.4 * p->font.large.size + widest_number(p) + 40 * u;
    p->space.right =
        110 * u + 28 * u + 14 * u + p->values.widest + 1.8 * p->font.large.size + 24 * u;
    s->scale = ((double)p->w - p->space.left - p->space.right) / box.w;
    if (s->scale * box.w < least * u)
        return rc_err_set(err,
                          "on a page of %zu pixels with text of that size there is no room for a "
                          "relief: ask for a larger --width",
                          p->w);
    p->plot = (struct box){0, 0, ceil(s->scale * box.w) + 1, ceil(s->scale * box.h) + 1};
    s->ox = -s->scale * box.x;
    s->oy = -s->scale * box.y;
    page_measure(p); /* the bar is as high as the box */
    figure_legend(p);
    page_settle(p, p->space.left, 22 * u, below_box(s));
    s->ox += p->plot.x;
    s->oy += p->plot.y;
    return RC_OK;
}

static enum rc_status
draw(struct page *p, struct rc_err *err)
{
    struct scene *s = scene_of(p);
    struct side side[3];

    draw_box(s);
    if (draw_image(s, err) != RC_OK)
        return RC_FAIL;
    set_sides(s, side);
    for (int k = 0; k < 3; k++)
        draw_side(s, &side[k]);
    p->plot.w += floor(110 * p->u - page_bar_right(p)); /* space for the marks of an axis */
    figure_bar(p);
    return RC_OK;
}

static const struct page_kind kind = {RELIEF_WIDTH, lay_out, draw, FIGURE_SAMPLE, figure_sample};

struct canvas *
relief_draw(const struct figure *f, const struct view *view, const struct rc_grid *g,
            struct rc_err *err)
{
    struct scene s = {.f = f, .view = view};
    struct canvas *drawn = NULL;

    if ((s.page = page_new(&kind, &s, &f->paper, err)) == NULL)
        return NULL;
    s.page->f = f;
    s.page->g = g;
    set_view(&s);
    if (set_mesh(&s, g, err) == RC_OK)
        drawn = pages_draw(&s.page, 1, err);
    free(s.value);
    free(s.page);
    return drawn;
}
