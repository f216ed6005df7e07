/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Body force of a manufactured motion, and the distance of the computed motion from it.
 *
 * The forces go to the grid with the kernel that scatters momentum: it is given the body force of
 * each point in place of its velocity, and records of its own. The force of a step is that of its
 * start, t(n), as the internal force is. */
#include "engine/effects/common.h"
#include "engine/effects/manufactured.h"
#include "engine/effects/params.h"

#include <math.h>
#include <string.h>

#include "engine/assemble.h"
#include "engine/core/mem.h"

#define AT(member) offsetof(pw_body_force_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"body", PW_KEY_BODY, AT(body), 0, 0, NULL, NULL, NULL, "neo-Hookean body that is driven"},
  {"kind", PW_KEY_CHOICE, AT(kind), 0, 0, NULL, 
   "axis_aligned_mms|vortex_mms|expanding_ring_mms", NULL,
   "manufactured motion: standing waves of a unit square, the vortex of a ring 0.75 to 1.25 m, or "
   "(axisymmetric) the radial motion of a ring 0.4 to 0.6 m"},
  {"amplitude_m", PW_KEY_REAL, AT(amplitude_m), -100, 100, NULL, NULL,
   "kind=axis_aligned_mms|expanding_ring_mms", "of the displacement"},
  {"rotation_rad", PW_KEY_REAL, AT(rotation_rad), -100, 100, NULL, NULL, "kind=vortex_mms",
   "amplitude of the vortex' rotation"},
  {"course", PW_KEY_CHOICE, AT(course), 0, 0, "sine", "sine|one_minus_cosine", "kind=vortex_mms",
   "rotation in time: sin(c pi t) or (1 - cos(2 c pi t)) / 2"},
  {"origin_m", PW_KEY_PAIR, AT(origin_m), -1e6, 1e6, "[0, 0]", NULL, NULL,
   "lower left corner of the square, or centre of the vortex"},
  {0}};
/* clang-format on */

typedef struct body_force {
  const pw_body_force_param *param;
  pw_sim *sim; /* for the hooks over blocks */
  pw_mms mms;
  pw_idx n;
  pw_real *x0;         /* [2][n] initial positions by id, from the origin; m */
  pw_real *force;      /* [2][ld] body force of points now; m/s2 */
  pw_real *rec;        /* [nnode][PW_NODE] nodal forces in the slots of momentum; N */
  pw_real *part;       /* scratch of sums */
  pw_real error, size; /* largest L2 norms so far: of the error, of the exact displacement */
} body_force;

static pw_real parameter(const pw_scene_material *m, const char *name)
{
  for (const pw_key *k = m->model->keys; k->name; k++) {
    if (strcmp(k->name, name) == 0) {
      return m->param[k->offset / sizeof(pw_real)];
    }
  }
  return 0.0;
}

/* m, or rad of the vortex. */
static pw_real amplitude(const pw_body_force_param *p)
{
  return p->kind == PW_MMS_VORTEX ? p->rotation_rad : p->amplitude_m;
}

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_body_force_param *p = param;
  const pw_scene_material *m = &scene->material[scene->body[p->body].material];
  PW_REQUIRE(strcmp(m->model->name, "neo_hookean") == 0, PW_ERR_SCENE,
             "body '%s' must be neo_hookean, it is %s", scene->body[p->body].name, m->model->name);
  bool ring = p->kind == PW_MMS_RING;
  PW_REQUIRE(scene->geometry == (ring ? PW_AXI : PW_PLANE), PW_ERR_SCENE,
             "the motion asked for is one of %s", ring ? "axisymmetry" : "plane strain");
  pw_real bulk = parameter(m, "bulk_modulus_pa"), mu = parameter(m, "shear_modulus_pa");
  PW_REQUIRE(!ring || fabs(bulk - 2.0 / 3.0 * mu) <= 1e-6 * mu, PW_ERR_SCENE,
             "the rims of the expanding ring are free of traction for a Poisson's ratio of 0 only: "
             "bulk_modulus_pa must be 2/3 of shear_modulus_pa");
  PW_REQUIRE(!ring || p->origin_m[0] == 0.0, PW_ERR_SCENE,
             "the axis of the expanding ring is x = 0, not origin_m = [%g, ...]", p->origin_m[0]);
  return PW_OK;
}

static void scatter_block(void *ctx, pw_idx block)
{
  body_force *c = ctx;
  pw_sim *sim = c->sim;
  const pw_points *p = &sim->points;
  const pw_idx *start = sim->blocks.point_start + (pw_off)block * sim->nbody + c->param->body;
  for (pw_idx i = start[0]; i < start[1]; i++) {
    pw_real x0[2] = {c->x0[p->id[i]], c->x0[c->n + p->id[i]]}, b[2];
    pw_mms_body_force(&c->mms, x0, sim->time, b);
    c->force[i] = b[0];
    c->force[p->ld + i] = b[1];
  }
  pw_transfer t = sim->transfer;
  t.v = c->force;
  if (start[0] < start[1]) {
    sim->kernels->p2g_momentum(&t, c->rec, start[0], start[1]);
  }
}

static pw_status add_force(pw_sim *sim, void *ctx)
{
  body_force *c = ctx;
  const pw_idx nnode = sim->nodes.nnode;
  memset(c->rec, 0, (size_t)nnode * PW_NODE * sizeof *c->rec);
  pw_assemble_coloured(&sim->blocks, sim->threads, scatter_block, c);
  pw_real *rec = pw_nodes_field(&sim->nodes, sim->body[c->param->body].field);
  const pw_real *own = c->rec;
#pragma omp parallel for default(none) shared(rec, own, nnode) num_threads(sim->threads)           \
    schedule(static)
  for (pw_idx k = 0; k < nnode; k++) {
    for (int a = 0; a < 2; a++) {
      rec[(pw_off)k * PW_NODE + PW_NODE_FORCE + a] += own[(pw_off)k * PW_NODE + PW_NODE_VEL + a];
    }
  }
  return PW_OK;
}

static void power(const void *ctx, pw_off first, pw_off last, pw_real *sum)
{
  const body_force *c = ctx;
  const pw_sim *sim = c->sim;
  const pw_real *rec = pw_nodes_field(&sim->nodes, sim->body[c->param->body].field);
  for (pw_off k = first * PW_NODE; k < last * PW_NODE; k += PW_NODE) {
    for (int a = 0; a < 2; a++) {
      sum[0] += c->rec[k + PW_NODE_VEL + a] * pw_node_mean_velocity(sim, rec + k, a);
    }
  }
}

/* Squares of the error and of the exact displacement, weighted with the initial volumes. */
static void squares(const void *ctx, pw_off first, pw_off last, pw_real *sum)
{
  const body_force *c = ctx;
  const pw_points *p = &c->sim->points;
  for (pw_off id = first; id < last; id++) {
    pw_idx i = p->slot[id];
    if (p->body[i] != c->param->body) {
      continue;
    }
    pw_real x0[2] = {c->x0[id], c->x0[c->n + id]}, u[2], vol0 = p->mass[i] / c->mms.density;
    pw_mms_displacement(&c->mms, x0, c->sim->time, u);
    for (int a = 0; a < 2; a++) {
      pw_real now = p->x[a * p->ld + i] - c->param->origin_m[a];
      pw_real e = now - x0[a] - u[a];
      sum[0] += vol0 * e * e;
      sum[1] += vol0 * u[a] * u[a];
    }
  }
}

static pw_status compare(pw_sim *sim, void *ctx)
{
  body_force *c = ctx;
  pw_real sum[PW_SUMS];
  pw_sum_items(power, c, sim->nodes.nnode, sim->threads, c->part, sum);
  sim->energy.external += sum[0] * sim->dt * sim->measure;
  pw_sum_items(squares, c, c->n, sim->threads, c->part, sum);
  c->error = pw_max(c->error, sqrt(sum[0]));
  c->size = pw_max(c->size, sqrt(sum[1]));
  return PW_OK;
}

static void results(const pw_sim *sim, void *ctx, pw_record *out)
{
  const body_force *c = ctx;
  (void)sim;
  pw_record_put(out, "mms_displacement_error", c->size > 0.0 ? c->error / c->size : 0.0);
}

static pw_status archive(pw_sim *sim, void *ctx, pw_archive *ar)
{
  body_force *c = ctx;
  (void)sim;
  PW_TRY(ar->real(ar, "body_force/error", &c->error, 1));
  return ar->real(ar, "body_force/size", &c->size, 1);
}

static void destroy(void **ctx)
{
  body_force *c = *ctx;
  if (c) {
    pw_mem_free(&c->x0);
    pw_mem_free(&c->force);
    pw_mem_free(&c->rec);
    pw_mem_free(&c->part);
  }
  pw_mem_free(ctx);
}

static pw_status allocate(pw_sim *sim, body_force *c)
{
  pw_off items = c->n > sim->nodes.nnode ? c->n : sim->nodes.nnode;
  PW_TRY(pw_mem_alloc("initial positions", 2 * (pw_off)c->n, sizeof(pw_real), &c->x0));
  PW_TRY(pw_mem_alloc("body forces", 2 * (pw_off)sim->points.ld, sizeof(pw_real), &c->force));
  PW_TRY(pw_mem_alloc("nodal body forces", (pw_off)sim->nodes.nnode * PW_NODE, sizeof(pw_real),
                      &c->rec));
  return pw_mem_alloc("body force sums", pw_sum_scratch(items), sizeof(pw_real), &c->part);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  body_force *c;
  PW_TRY(pw_mem_alloc("body force", 1, sizeof *c, &c));
  *ctx = c;
  const pw_body_force_param *p = param;
  const pw_scene_material *m = &sim->scene.material[sim->scene.body[p->body].material];
  pw_real mu = parameter(m, "shear_modulus_pa");
  c->param = p;
  c->sim = sim;
  c->n = sim->points.n;
  c->mms = (pw_mms){.kind = p->kind,
                    .course = p->course,
                    .amplitude = amplitude(p),
                    .lambda = parameter(m, "bulk_modulus_pa") - 2.0 / 3.0 * mu,
                    .mu = mu,
                    .density = pw_scene_density(&sim->scene, p->body)};
  PW_TRY(allocate(sim, c));
  pw_points *pt = &sim->points;
  for (pw_idx i = 0; i < pt->n; i++) {
    pw_real v[2], x0[2];
    for (int a = 0; a < 2; a++) {
      x0[a] = c->x0[a * c->n + pt->id[i]] = pt->x[a * pt->ld + i] - p->origin_m[a];
    }
    if (pt->body[i] == p->body) {
      pw_mms_velocity(&c->mms, x0, 0.0, v);
      pt->v[i] = v[0];
      pt->v[pt->ld + i] = v[1];
    }
  }
  return PW_OK;
}

static const pw_hook hooks[] = {
    {PW_STAGE_NODE_FORCE, add_force},
    {PW_STAGE_END, compare},
    {0, NULL},
};

const pw_effect pw_effect_body_force = {
    .name = "body_force",
    .brief = "body force of a manufactured motion, and the error against it",
    .keys = keys,
    .hooks = hooks,
    .check = check,
    .create = create,
    .destroy = destroy,
    .results = results,
    .archive = archive,
};
