/* SPDX-License-Identifier: GPL-3.0-or-later */
/*
 * Effects that are estimated from the maps of one contact. Constants were set on computed contacts
 * (tests/scene); an interval of an area is one or two nodes wider.
 */
#include <complex.h>
#include <stdio.h>

#include "libcontact/adhesion/adhesion.h"
#include "libcontact/transform/fourier.h"
#include "parts.h"

/* The most that the area can grow. */
static double
room_of(const struct rc_scene *s)
{
    const struct rc_contact *c = &s->now.contact;

    return 1 / c->contact_fraction - 1;
}

static void
set_area(const struct rc_scene *s, struct rc_scene_effect *e, double low, double high)
{
    scene_set(e, RC_SCENE_AREA, fmin(low, room_of(s) / 2), fmin(high, room_of(s)));
}

/* How the area may differ from that of a contact: `least` to `most` times its change, and nodes that would
 * join or leave if the effect were `more` times larger, or a gap closed by `tiny` of the largest closing. */
struct spread {
    double least, most, more, tiny;
};

/* The interval of an area, from the nodes that join from one contact to another. Both ends are whole nodes,
 * so that they have a node to spare. Nodes that join and nodes that leave cancel in the area: each such pair
 * widens the interval by one node, as the true contact may have only one of the two. */
static void
set_nodes(const struct rc_scene *s, struct rc_scene_effect *e, const struct solved *to,
          struct spread by)
{
    const double n = (double)s->now.contact.contact_nodes,
                 joined = fabs((double)to->contact.contact_nodes - n);
    double closing = 0, join = 0, leave = 0, in = 0, out = 0;

    for (size_t k = 0; k < s->n; k++)
        closing = fmax(closing, s->now.gap[k] - to->gap[k]);
    for (size_t k = 0; k < s->n; k++) {
        const double closes = fmax(s->now.gap[k], 0) - to->gap[k], falls = s->now.p[k] - to->p[k];
        join += !(to->p[k] > 0) && to->gap[k] <= (by.more - 1) * closes + by.tiny * closing;
        leave += to->p[k] > 0 && to->p[k] <= (by.more - 1) * falls;
        in += !(s->now.p[k] > 0) && to->p[k] > 0;
        out += s->now.p[k] > 0 && !(to->p[k] > 0);
    }
    set_area(s, e, (floor(by.least * joined) - leave - fmin(in, out)) / n,
             (ceil(by.most * joined) + fmax(join, leave) + fmin(in, out)) / n);
}

static double
composite(const struct rc_pair *pair)
{
    double two = pair->two.e > 0 ? (1 - pair->two.nu * pair->two.nu) / pair->two.e : 0;

    return pair->estar > 0 ? pair->estar
                           : 1 / ((1 - pair->one.nu * pair->one.nu) / pair->one.e + two);
}

/* ---- yield ---- */

/* The load above a limit of the pressure, over the load below it. */
static double
above(const struct rc_scene *s, double limit)
{
    double sum = 0, over = 0;

    for (size_t k = 0; k < s->n; k++) {
        sum += s->elastic.p[k];
        over += fmax(s->elastic.p[k] - limit, 0);
    }
    return over / (sum - over);
}

enum rc_status
scene_mises(struct rc_scene *s, const double *p, double *most, double *at, struct rc_err *err)
{
    struct rc_stress_options o = {.boundary = s->problem.boundary,
                                  .body = s->plain.pair.one,
                                  .wanted = 1U << RC_MISES,
                                  .threads = s->problem.threads};
    RC_OWNED double *depth = NULL;
    RC_OWNED double *map = rc_alloc(s->n, sizeof *map);
    double *to[RC_STRESSES] = {[RC_MISES] = map};
    size_t depths = 0;

    *most = *at = 0;
    if (map == NULL)
        return rc_err_set(err, "out of memory for the stress");
    if (rc_stress_depths(NULL, &s->shape, p, o.boundary, &o.body, &depth, &depths, err) != RC_OK)
        return RC_FAIL;
    o.depth = depth;
    o.depths = depths;
    RC_OWN(rc_stress, stress) = rc_stress_new(&s->shape, p, &o, err);
    for (size_t d = 0; d < depths; d++) {
        if (stress == NULL || rc_stress_slice(stress, depth[d], to, err) != RC_OK)
            return RC_FAIL;
        for (size_t k = 0; k < s->n; k++)
            if (map[k] > *most) {
                *most = map[k];
                *at = depth[d];
            }
    }
    return RC_OK;
}

/* Below the yield stress everywhere the elastic contact is the solution. Above, a hardness of 1.6 Y (first
 * yield of a sphere) grows the contact more than yield does, and one of 2.8 Y (full plasticity) less. */
enum rc_status
scene_yield(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const double y = s->data.yield, node = 1 / (double)s->elastic.contact.contact_nodes,
                 nearly = fmax(0.95, 1 - 1.7 * node), sure = 1.3, far = 2;
    double mises, depth, c, v, soft, hard;

    if (s->problem.pair.one.layers > 0) {
        snprintf(e->unfit, sizeof e->unfit, "yield is computed in uniform bodies only");
        return RC_OK;
    }
    if (scene_mises(s, s->elastic.p, &mises, &depth, err) != RC_OK)
        return RC_FAIL;
    c = mises / y;
    scene_number(e, "mises_over_yield", c);
    e->basis = scene_elastic_basis(s);
    if (c <= nearly) /* the peak may lie between two depths */
        return RC_OK;
    e->basis = RC_SCENE_CALIBRATED;
    v = 1 - nearly / c;
    soft = above(s, 1.6 * y);
    hard = above(s, 2.8 * y);
    scene_set(e, RC_SCENE_PRESSURE, c > far ? 0.15 * v : c > sure ? 0.06 * v : 0, fmin(1.1 * v, 1));
    set_area(s, e, 0.3 * hard - node, 0.55 * soft + 1.5 * node);
    scene_set(e, RC_SCENE_APPROACH, 0.05 * hard, 0.15 * soft + 0.003 * v);
    return RC_OK;
}

/* ---- adhesion ---- */

enum rc_status
scene_attracted(struct rc_scene *s, const struct rc_adhesion_problem *problem,
                const struct rc_adhesion_scales *scales, const struct solved *from, double load,
                double *sum, struct rc_err *err)
{
    const struct rc_conv_options o = {.boundary = s->problem.boundary,
                                      .threads = s->problem.threads};
    struct rc_problem p = s->problem;
    struct asked asked = {.problem = &p};
    double most = 0;
    enum rc_status status;
    RC_OWNED double *sigma = rc_alloc(s->n, sizeof *sigma);
    RC_OWNED double *h = rc_alloc(s->n, sizeof *h);
    RC_OWN(rc_conv, conv) = rc_conv_new(&s->shape, &p.pair, &o, err);

    if (sigma == NULL || h == NULL)
        return rc_err_set(err, "out of memory for an attraction");
    if (conv == NULL || rc_adhesion_attraction(&s->shape, problem, from->gap, sigma, err) != RC_OK)
        return RC_FAIL;
    for (size_t k = 0; k < s->n; k++)
        sigma[k] = from->p[k] > 0 ? scales->strength : sigma[k];
    rc_conv_apply(conv, sigma, h);
    for (size_t k = 0; k < s->n; k++)
        h[k] += s->h[k];
    *sum = rc_sum(sigma, s->n) * s->shape.dx * s->shape.dy;
    p.load = load + *sum;
    asked.h = h;
    status = scene_solve(s, &asked, &s->other, err);
    for (size_t k = 0; k < s->n; k++)
        most = fmax(most, s->other.p[k] - sigma[k]);
    s->other.contact.max_pressure = most;
    s->other.contact.approach = NAN; /* h is not the shape */
    return status;
}

bool
scene_adheres(const struct rc_scene *s, const struct rc_adhesion_problem *problem,
              struct rc_adhesion_scales *scales, struct rc_scene_effect *e)
{
    const double resolved = 1.1;

    if (rc_adhesion_check(&s->shape, problem, scales, NULL) != RC_OK) {
        snprintf(e->unfit, sizeof e->unfit, "rc-solve --adhesion refuses this contact");
        return false;
    }
    scene_number(e, "cohesive_nodes", scales->cohesive_nodes);
    if (scales->cohesive_nodes < resolved) {
        snprintf(e->unfit, sizeof e->unfit,
                 "the grid does not resolve the law: give a spacing of at most %.2g m, or a larger "
                 "range",
                 fmax(s->shape.dx, s->shape.dy) * scales->cohesive_nodes / resolved);
        return false;
    }
    return true;
}

/* Elastic contacts under the attraction at the gap of the contact before: the attraction only grows
 * from one to the next, and their area is below that of the adhesive contact. On 200 scenes the change
 * of the second one was 1 to 1.9 times smaller than that of the adhesive contact in area, and 1 to 1.3
 * times in pressure. */
enum rc_status
scene_adhesion(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const struct rc_adhesion_problem problem = {
        .contact = s->problem, .work = s->data.work, .law = s->data.law, .range = s->data.range};
    double change[RC_SCENE_FIGURES], sum;
    struct rc_adhesion_scales scales;
    enum rc_status status = RC_OK;

    e->basis = RC_SCENE_CALIBRATED;
    if (!scene_adheres(s, &problem, &scales, e))
        return RC_OK;
    for (int step = 0; step < 2 && status == RC_OK; step++)
        status = scene_attracted(s, &problem, &scales, step == 0 ? &s->now : &s->other,
                                 s->problem.load, &sum, err);
    if (status == RC_SHORT)
        snprintf(e->unfit, sizeof e->unfit, "its contact does not converge");
    if (status != RC_OK)
        return status;
    scene_changes(&s->now, &s->other, change);
    set_nodes(s, e, &s->other, (struct spread){0.9, 1.5, 2, 0.05});
    scene_set(e, RC_SCENE_PRESSURE, 0.98 * change[RC_SCENE_PRESSURE] - 0.0005,
              1.5 * change[RC_SCENE_PRESSURE] + 0.001);
    if (rc_there(change[RC_SCENE_APPROACH]))
        scene_set(e, RC_SCENE_APPROACH, 0.98 * change[RC_SCENE_APPROACH] - 0.0003,
                  2 * change[RC_SCENE_APPROACH] + 0.0005);
    return RC_OK;
}

/* ---- wear ---- */

/* One implicit step of Archard's law over the whole distance is the contact of bodies with the
 * compliance k s at each node. A wave that decays as exp(-x) falls to 1/(1 + x) in it. On 200 scenes of
 * 48 x 48 nodes the pressure changed by 0.98 to 1.31 times as much, and the area by 0.84 to 1.11 times. */
enum rc_status
scene_wear(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const double worn = s->data.wear * s->data.distance;
    struct rc_problem p = s->problem;
    struct asked asked = {.h = s->now.shape, .compliance = worn};
    double change[RC_SCENE_FIGURES];
    enum rc_status status;

    scene_number(e, "depth_over_flattening",
                 worn * s->now.contact.max_pressure / s->now.contact.approach);
    e->basis = RC_SCENE_CALIBRATED;
    asked.problem = &p;
    p.hardness = 0; /* the dented shape carries its pressure without it */
    status = scene_solve(s, &asked, &s->other, err);
    if (status == RC_SHORT)
        snprintf(e->unfit, sizeof e->unfit, "its contact does not converge");
    if (status != RC_OK)
        return status;
    scene_changes(&s->now, &s->other, change);
    scene_set(e, RC_SCENE_PRESSURE, s->accepted ? 0 : 0.95 * change[RC_SCENE_PRESSURE] - 0.0005,
              fmin(1.4 * change[RC_SCENE_PRESSURE] + 0.001, 1));
    set_nodes(s, e, &s->other, (struct spread){0.8, 1.15, 1.4, 0.05});
    return RC_OK;
}

/* ---- heat ---- */

/* The largest displacement of uniform bodies under the pressure. */
static enum rc_status
largest_displacement(struct rc_scene *s, double *most, struct rc_err *err)
{
    const struct rc_conv_options o = {.boundary = s->problem.boundary,
                                      .threads = s->problem.threads};
    const double *u = s->now.u;
    RC_OWNED double *uniform = NULL;

    *most = 0;
    if (s->problem.pair.one.layers > 0) {
        RC_OWN(rc_conv, conv) = rc_conv_new(&s->shape, &s->plain.pair, &o, err);
        if (conv == NULL)
            return RC_FAIL;
        if ((uniform = rc_alloc(s->n, sizeof *uniform)) == NULL)
            return rc_err_set(err, "out of memory for a displacement");
        rc_conv_apply(conv, s->now.p, uniform);
        s->convolutions++;
        u = uniform;
    }
    for (size_t k = 0; k < s->n; k++)
        *most = fmax(*most, u[k]);
    return RC_OK;
}

/* Bodies at rest: conduction and elastic displacement have the same kernel 1/r, so that the temperature
 * of a body is proportional to the displacement of uniform bodies. Motion lowers it, to the sum of both
 * limits of Jaeger (1942) at the radius of the largest patch. The mean flux of a periodic map heats
 * each body as a wall, since time 0. Both bodies have the same temperature in contact: their
 * resistances are in parallel. */
enum rc_status
scene_heat(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const struct rc_scene_data *d = &s->data;
    const struct rc_contact *c = &s->now.contact;
    const bool periodic = rc_repeats(s->problem.boundary) == 2;
    const int moves = d->moving == 1 ? 0 : 1;
    const double speed = fabs(d->speed), flux = d->mu * speed;
    double most = 0, largest, peclet, rest[2], motion[2], still, moving;

    e->basis = RC_SCENE_CALIBRATED;
    if (rc_repeats(s->problem.boundary) == 1) {
        snprintf(e->unfit, sizeof e->unfit,
                 "heat is not estimated on maps that repeat along one axis");
        return RC_OK;
    }
    if (periodic && !(d->time > 0)) {
        snprintf(e->unfit, sizeof e->unfit,
                 "a periodic map has no steady temperature: give --time");
        return RC_OK;
    }
    if (scene_patches(s, &largest, NULL, err) != RC_OK)
        return RC_FAIL;
    if (largest_displacement(s, &most, err) != RC_OK)
        return RC_FAIL;
    peclet = speed * sqrt(largest / RC_PI) / (2 * d->diffusivity[moves]);
    for (int b = 0; b < 2; b++) {
        const double wall = periodic ? 2 * c->mean_pressure * sqrt(d->time / RC_PI) *
                                           sqrt(d->diffusivity[b]) / d->conductivity[b]
                                     : 0;
        rest[b] = composite(&s->plain.pair) * most / (2 * d->conductivity[b]);
        motion[b] = rest[b] / (b == moves ? sqrt(1 + 2 * peclet) : 1) + wall;
        rest[b] += wall;
    }
    still = flux * rest[0] * rest[1] / (rest[0] + rest[1]);
    moving = flux * motion[0] * motion[1] / (motion[0] + motion[1]);
    scene_number(e, "temperature_at_rest", still);
    scene_number(e, "temperature_in_motion", moving);
    scene_number(e, "peclet", peclet);
    /* a steady state is not reached at once */
    scene_set(e, RC_SCENE_TEMPERATURE,
              d->time > 0 && !periodic ? 0 : (periodic ? 0.2 : 0.9) * moving,
              fmin(1.02 * still, 3 * moving));
    return RC_OK;
}

/* ---- friction of dissimilar bodies ---- */

/* Dundurs' second constant. */
static double
dundurs(const struct rc_pair *pair)
{
    const struct rc_body *a = &pair->one, *b = &pair->two;
    const double ca = 2 * (1 + a->nu) / a->e, cb = b->e > 0 ? 2 * (1 + b->nu) / b->e : 0; /* 1/G */

    return ((1 - 2 * a->nu) * ca - (1 - 2 * b->nu) * cb) /
           (2 * ((1 - a->nu) * ca + (1 - b->nu) * cb));
}

/* Pressure and traction of the pressed bodies in four increments. In sixteen the pressure of 200 scenes
 * changed by 0.69 to 1.39 times as much, and the approach by 0.77 to 1.13 times. Where they slide,
 * tractions of mu p change the pressure by up to mu beta. Full stick under an axisymmetric punch raises load
 * over approach by ln((1 + beta)/(1 - beta))/(2 beta) (Spence 1968, Proc. R. Soc. A 305, 55), full stick of
 * a wave by 1/(1 - beta^2). */
enum rc_status
scene_dissimilar(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const double beta = fabs(dundurs(&s->plain.pair)), mu = s->data.mu,
                 slides = s->data.speed != 0 || s->data.tangential >= mu * s->problem.load
                              ? 1.5 * mu * beta
                              : 0,
                 node = 1 / (double)s->now.contact.contact_nodes, tol = 0.01;
    const struct rc_friction_problem law = {.law = {.boundary = s->problem.boundary,
                                                    .pair = s->problem.pair,
                                                    .mu = mu,
                                                    .tol = tol,
                                                    .threads = s->problem.threads},
                                            .increments = 4};
    struct rc_problem inner = s->problem;
    struct rc_point to = {0};
    double change[RC_SCENE_FIGURES];
    enum rc_status status;

    scene_number(e, "beta", beta);
    e->basis = RC_SCENE_EXACT;
    if (beta < 1e-12)
        return RC_OK;
    e->basis = RC_SCENE_CALIBRATED;
    if (s->problem.pair.one.layers > 0) {
        snprintf(e->unfit, sizeof e->unfit,
                 "friction of dissimilar bodies is computed for uniform bodies only");
        return RC_OK;
    }
    inner.tol = tol / 100;
    RC_OWN(rc_model, m) =
        rc_friction_new(rc_elastic_new(&s->shape, s->h, &inner, NULL, err), s->h, &law, err);
    rc_point_set(&to, RC_LOAD, s->problem.load);
    rc_point_set(&to, RC_TANGENTIAL_X, 0);
    rc_point_set(&to, RC_TANGENTIAL_Y, 0);
    status = m == NULL ? RC_FAIL : rc_model_run(m, &to, err);
    if (status == RC_FAIL || rc_model_look(m, NULL, err) == RC_FAIL)
        return RC_FAIL;
    if (!rc_store_need(&s->own, s->n, &s->other.p) || !rc_store_need(&s->own, s->n, &s->other.gap))
        return rc_err_set(err, "out of memory for a contact");
    if (rc_model_frame(m, "pressure", s->other.p, err) != RC_OK ||
        rc_model_frame(m, "gap", s->other.gap, err) != RC_OK)
        return RC_FAIL;
    s->other.contact = rc_elastic_result(m)->contact;
    s->convolutions += rc_friction_result(m)->convolutions;
    scene_changes(&s->now, &s->other, change);
    scene_set(e, RC_SCENE_PRESSURE, 0.6 * change[RC_SCENE_PRESSURE] - 0.001,
              fmax(1.5 * change[RC_SCENE_PRESSURE] + 0.001, slides));
    set_nodes(s, e, &s->other, (struct spread){0.6, 1.2, 1.5, 0.01});
    if (slides > 0)
        set_area(s, e, e->change[RC_SCENE_AREA].low,
                 fmax(2 * change[RC_SCENE_AREA], slides) + 2 * node);
    if (!(s->problem.hardness > 0)) /* with dents the approach counts from another shape */
        scene_set(e, RC_SCENE_APPROACH, 0.7 * change[RC_SCENE_APPROACH] - 0.0005,
                  1.2 * change[RC_SCENE_APPROACH] + 0.0005 + 0.02 * mu * beta);
    return RC_OK;
}

/* ---- sliding on rubber ---- */

/* Sums over the waves of the pressure of `s`: of 1/q, and of 1/(q E(i qx V)) over the compliance of the pair
 * at rest; the friction, by Im J. */
struct waves {
    double plain;
    double complex softer;
    double friction, mean_q;
};

static double complex
compliance_at(const struct rc_scene *s, double omega)
{
    const struct rc_pair *pair = &s->plain.pair;
    const double nu = pair->one.nu,
                 body = pair->estar > 0 ? 1 / pair->estar : (1 - nu * nu) / pair->one.e,
                 two = pair->estar > 0 || !(pair->two.e > 0)
                           ? 0
                           : (1 - pair->two.nu * pair->two.nu) / pair->two.e;
    double modulus[2], compliance[2];

    if (omega == 0)
        return body / s->data.material->relaxed / s->data.material->instant + two;
    rc_relaxation_dynamic(s->data.material, fabs(omega), modulus, compliance);
    return body * (compliance[0] + I * (omega > 0 ? compliance[1] : -compliance[1])) /
               s->data.material->instant +
           two;
}

static enum rc_status
sum_waves(const struct rc_scene *s, const double *p, struct waves *to, struct rc_err *err)
{
    const struct rc_shape *shape = &s->shape;
    const size_t columns = rc_fourier_columns(shape);
    const double mean = rc_sum(p, s->n) / (double)s->n;
    double power = 0, along = 0;
    RC_OWNED double complex *w = rc_alloc(rc_fourier_size(shape), sizeof *w);

    if (w == NULL)
        return rc_err_set(err, "out of memory for the waves of a pressure");
    if (rc_fourier_forward(shape, p, w, err) != RC_OK)
        return RC_FAIL;
    *to = (struct waves){0};
    for (size_t i = 0; i < columns; i++) {
        const double qx = rc_fourier_q(i, shape->nx, shape->dx);
        const double complex j0 = compliance_at(s, qx * fabs(s->data.speed));
        const double twice = i == 0 || 2 * i == shape->nx ? 1 : 2;
        for (size_t j = 0; j < shape->ny; j++) {
            const double q = hypot(qx, rc_fourier_q(j, shape->ny, shape->dy)),
                         a = cabs(w[j * columns + i]) / (double)s->n, of = twice * a * a;
            if (q == 0)
                continue;
            to->plain += of / q;
            to->softer += of / q * j0;
            to->friction += of * qx * -2 * cimag(j0) / q;
            power += of;
            along += of * q;
        }
    }
    to->friction /= mean;
    to->mean_q = power > 0 ? along / power : 0;
    return RC_OK;
}

/* The modulus of the rubber at this speed is a mean over the waves of the relaxed contact, and one more
 * contact with it gives friction and change. The loss tangent widens what the asymmetry of the contact
 * adds. */
enum rc_status
scene_sliding(struct rc_scene *s, struct rc_scene_effect *e, struct rc_err *err)
{
    const double few = 0.02; /* nodes that join or leave */
    struct rc_problem p = s->plain;
    struct solved relaxed = {0};
    struct waves waves;
    double complex j;
    double loss, area, pressure, approach, node;

    e->basis = RC_SCENE_CALIBRATED;
    if (rc_repeats(s->problem.boundary) != 2) {
        snprintf(e->unfit, sizeof e->unfit, "sliding on rubber is computed on periodic maps only");
        return RC_OK;
    }
    if (!(s->data.material->relaxed > 0)) {
        snprintf(e->unfit, sizeof e->unfit, "the material flows without end");
        return RC_OK;
    }
    p.pair = (struct rc_pair){.estar = 1 / creal(compliance_at(s, 0))};
    if (scene_solve(s, &(struct asked){.problem = &p}, &s->other, err) != RC_OK ||
        sum_waves(s, s->other.p, &waves, err) != RC_OK)
        return RC_FAIL;
    relaxed.contact = s->other.contact;
    p.pair.estar = waves.plain / cabs(waves.softer);
    if (scene_solve(s, &(struct asked){.problem = &p}, &s->other, err) != RC_OK ||
        sum_waves(s, s->other.p, &waves, err) != RC_OK)
        return RC_FAIL;
    j = compliance_at(s, 0.64 * waves.mean_q * fabs(s->data.speed));
    loss = fabs(cimag(j)) / creal(j);
    area = fabs(s->other.contact.contact_area / relaxed.contact.contact_area - 1);
    pressure = fabs(s->other.contact.max_pressure / relaxed.contact.max_pressure - 1);
    approach = fabs(s->other.contact.approach / relaxed.contact.approach - 1);
    node = 1 / (double)s->now.contact.contact_nodes;
    if (fabs(waves.plain / cabs(waves.softer) * creal(compliance_at(s, 0)) - 1) + loss < few * node)
        node = 0; /* the rubber is as good as relaxed */
    scene_number(e, "modulus_at_speed", p.pair.estar);
    scene_number(e, "loss_tangent", loss);
    scene_set(e, RC_SCENE_AREA, 0.9 * area - node, 1.6 * area + 0.4 * loss + 2 * node);
    scene_set(e, RC_SCENE_PRESSURE, 0.5 * pressure - 0.002, 2.5 * pressure + 1.2 * loss + 0.002);
    scene_set(e, RC_SCENE_APPROACH, 0.5 * approach - 0.001, 2 * approach + 0.001);
    scene_set(e, RC_SCENE_FRICTION, 0.95 * waves.friction, 2 * waves.friction);
    return RC_OK;
}
