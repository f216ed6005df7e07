/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Loads: tractions on surfaces of the mesh, and gravity.
 *
 * Tractions act on the surface where the mesh has it at the start; they keep their direction (dead
 * loads). A body that leaves that surface ends the run. A pressure may follow the surface of the
 * material instead (engine/tet_follow.h). Gravity acts on the points where they are at the start of a
 * part of a step.
 */
#include "engine/effects/solid_params.h"

#include <math.h>
#include <stdio.h>

#include "engine/core/mem.h"
#include "engine/tet_follow.h"
#include "engine/tet_loads.h"

#define AT(member) offsetof(pw_traction_param, member)

/* clang-format off */
static const pw_key traction_keys[] = {
  {"group", PW_KEY_TEXT, AT(group), 0, 0, NULL, NULL, NULL,
   "surface of the mesh, or side of a box, that is loaded"},
  {"kind", PW_KEY_CHOICE, AT(kind), 0, 0, "pressure", "pressure|traction|force", NULL,
   "a pressure onto the surface, a traction, or a force spread evenly; on cells that bodies fill"},
  {"pressure_pa", PW_KEY_REAL, AT(pressure_pa), -1e15, 1e15, NULL, NULL, "kind=pressure",
   "pressure in the end, onto the body"},
  {"follower", PW_KEY_BOOL, AT(follower), 0, 0, "false", NULL, "kind=pressure",
   "the pressure goes with the surface of the material and stays normal to it"},
  {"traction_pa", PW_KEY_TRIPLE, AT(traction_pa), -1e15, 1e15, NULL, NULL, "kind=traction",
   "force per area in the end"},
  {"total_force_n", PW_KEY_TRIPLE, AT(force_n), -1e15, 1e15, NULL, NULL, "kind=force",
   "force on the whole surface in the end"},
  PW_SOLID_RAMP_KEYS(AT(ramp)),
  {0}};

static const pw_key gravity_keys[] = {
  {"acceleration_m_s2", PW_KEY_TRIPLE, offsetof(pw_solid_gravity_param, acceleration_m_s2), -1e6,
   1e6, NULL, NULL, NULL, "acceleration of gravity in the end"},
  PW_SOLID_RAMP_KEYS(offsetof(pw_solid_gravity_param, ramp)),
  {0}};
/* clang-format on */

typedef struct load {
  const void *param;
  const pw_solid_ramp *ramp;
  int number;
  pw_idx n;
  pw_idx *node;           /* [n] traction: loaded nodes */
  pw_real *force;         /* [n][3] traction: whole force of a node; N */
  pw_real part;           /* of the load, so far */
  pw_real sum[3];         /* whole force; N */
  pw_tet_follow *surface; /* of a pressure that follows, in place of nodes and forces; or NULL */
} load;

static void destroy(void **ctx)
{
  load *l = *ctx;
  if (l) {
    pw_mem_free(&l->node);
    pw_mem_free(&l->force);
    pw_tet_follow_destroy(&l->surface);
  }
  pw_mem_free(ctx);
}

static void moved(pw_implicit *sim, void *ctx, pw_real to)
{
  load *l = ctx;
  l->part = pw_solid_course(sim, l->ramp->start_step, l->ramp->ramp_steps, to);
}

/* Area vector of a triangle, either way round: half the cross product of two edges. */
static void area_of(const pw_solid_mesh *mesh, const pw_idx *face, pw_real *area)
{
  const pw_tet_input *in = &mesh->input;
  pw_real a[3], b[3];
  for (int c = 0; c < 3; c++) {
    const pw_real *x = in->x + (pw_off)c * in->nnode;
    a[c] = x[face[1]] - x[face[0]];
    b[c] = x[face[2]] - x[face[0]];
  }
  for (int c = 0; c < 3; c++) {
    area[c] = 0.5 * (a[(c + 1) % 3] * b[(c + 2) % 3] - a[(c + 2) % 3] * b[(c + 1) % 3]);
  }
}

static bool same_face(const pw_idx *a, const pw_idx *b)
{
  int common = 0;
  for (int i = 0; i < 9; i++) {
    common += a[i / 3] == b[i % 3];
  }
  return common == 3;
}

/* The face of the mesh's boundary that a triangle is, as 4 e + f; -1: it is inside. */
static pw_idx boundary_face(const pw_tets *t, const pw_idx *triangle)
{
  for (pw_idx k = t->node_start[triangle[0]]; k < t->node_start[triangle[0] + 1]; k++) {
    const pw_idx e = t->node_elem[k];
    for (pw_idx f = 0; f < 4; f++) {
      pw_idx node[3];
      for (int i = 0; i < 3; i++) {
        node[i] = t->node[4 * e + pw_tet_face[f][i]];
      }
      if (t->beside[4 * e + f] < 0 && same_face(node, triangle)) {
        return 4 * e + f;
      }
    }
  }
  return -1;
}

/* Traction on a triangle with the outward area vector @p area. */
static void force_of(const pw_traction_param *p, const pw_real *area, pw_real whole, pw_real *force)
{
  const pw_real size = sqrt(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]);
  for (int c = 0; c < 3; c++) {
    force[c] = p->kind == PW_LOAD_PRESSURE   ? -p->pressure_pa * area[c]
               : p->kind == PW_LOAD_TRACTION ? p->traction_pa[c] * size
                                             : p->force_n[c] * size / whole;
  }
}

/* Place of a node in the ascending list of a group. */
static pw_idx place_of(const pw_solid_group *g, pw_idx node)
{
  pw_idx low = 0, high = g->nnode - 1;
  while (low < high) {
    const pw_idx middle = (low + high) / 2;
    if (g->node[middle] < node) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

/* Where a traction acts. */
typedef struct surface {
  uint8_t *filled; /* [npatch] 1: a cell with points; forces on others would act on nothing */
  pw_idx *face;    /* [faces of the group] 4 e + f, or -1 */
  pw_real area;    /* m2 */
} surface;

static void find_filled(const pw_implicit *sim, uint8_t *filled)
{
  const pw_tet_points *q = &sim->model.points;
  for (pw_idx i = 0; i < q->n; i++) {
    filled[q->elem[i] / sim->mesh.per] = 1;
  }
}

/* The boundary faces of the group that belong to cells with points, -1 for the others, and their
 * whole area. */
static pw_status find_faces(const pw_implicit *sim, const pw_solid_mesh *mesh,
                            const pw_solid_group *g, const load *l, surface *out)
{
  find_filled(sim, out->filled);
  out->area = 0.0;
  for (pw_idx k = 0; k < g->nface; k++) {
    pw_real area[3];
    const pw_idx face = boundary_face(&sim->mesh.tets, g->face + 3 * k);
    PW_REQUIRE(face >= 0, PW_ERR_SCENE,
               "traction.%d.group: the surface '%s' does not lie on the boundary of the mesh",
               l->number, g->name);
    const bool loaded = out->filled[face / 4 / sim->mesh.per];
    area_of(mesh, g->face + 3 * k, area);
    out->face[k] = loaded ? face : -1;
    out->area += loaded ? sqrt(area[0] * area[0] + area[1] * area[1] + area[2] * area[2]) : 0.0;
  }
  PW_REQUIRE(out->area > 0.0, PW_ERR_SCENE,
             "traction.%d.group: no body fills the cells at the surface '%s'", l->number, g->name);
  return PW_OK;
}

/* The nodes of a face of the mesh, so that their area vector points outwards. */
static void turn_outward(const pw_tets *t, pw_idx face, pw_idx *node)
{
  for (int i = 0; i < 3; i++) {
    node[i] = t->node[4 * (face / 4) + pw_tet_face[face % 4][i]];
  }
}

static void spread(const pw_implicit *sim, const pw_solid_mesh *mesh, const pw_solid_group *g,
                   const surface *on, load *l)
{
  for (pw_idx k = 0; k < g->nface; k++) {
    const pw_idx face = on->face[k];
    pw_real force[3], area[3];
    pw_idx outward[3];
    if (face < 0) {
      continue;
    }
    turn_outward(&sim->mesh.tets, face, outward);
    area_of(mesh, outward, area);
    force_of(l->param, area, on->area, force);
    for (int i = 0; i < 9; i++) {
      l->force[3 * place_of(g, outward[i / 3]) + i % 3] += force[i % 3] / 3.0;
      l->sum[i % 3] += force[i % 3] / 3.0;
    }
  }
}

/* Forces of the nodes of a surface that keep their direction. */
static pw_status create_dead(pw_implicit *sim, const pw_solid_mesh *mesh, const pw_solid_group *g,
                             const surface *on, load *l)
{
  l->n = g->nnode;
  PW_TRY(pw_mem_alloc("traction: nodes", l->n, sizeof *l->node, &l->node));
  PW_TRY(pw_mem_alloc("traction: forces", 3 * (pw_off)l->n, sizeof *l->force, &l->force));
  for (pw_idx i = 0; i < l->n; i++) {
    l->node[i] = g->node[i];
  }
  spread(sim, mesh, g, on, l);
  return PW_OK;
}

/* A point in the middle of every loaded face. */
static pw_status create_follower(pw_implicit *sim, const pw_solid_mesh *mesh,
                                 const pw_solid_group *g, const surface *on, load *l)
{
  pw_idx n = 0;
  for (pw_idx k = 0; k < g->nface; k++) {
    n += on->face[k] >= 0;
  }
  PW_TRY(pw_tet_follow_create(&sim->model, n, &l->surface));
  pw_tet_follow *f = l->surface;
  pw_idx i = 0;
  for (pw_idx k = 0; k < g->nface; k++) {
    const pw_idx face = on->face[k];
    pw_idx outward[3];
    pw_real area[3];
    if (face < 0) {
      continue;
    }
    turn_outward(&sim->mesh.tets, face, outward);
    area_of(mesh, outward, area);
    for (pw_idx c = 0; c < 3; c++) {
      const pw_real *x = mesh->input.x + (pw_off)c * mesh->input.nnode;
      f->x[c * n + i] = (x[outward[0]] + x[outward[1]] + x[outward[2]]) / 3.0;
      f->area[c * n + i] = area[c];
    }
    f->elem[i++] = face / 4;
  }
  return PW_OK;
}

static pw_status create_traction(pw_implicit *sim, const pw_solid_mesh *mesh, const void *param,
                                 void **ctx)
{
  load *l;
  const pw_traction_param *p = param;
  const pw_solid_group *g = NULL;
  char path[PW_NAME];
  PW_TRY(pw_mem_alloc("traction", 1, sizeof *l, &l));
  *ctx = l;
  l->param = param;
  l->ramp = &p->ramp;
  l->number = pw_solid_instance_of(sim, param);
  snprintf(path, sizeof path, "traction.%d.group", l->number);
  PW_TRY(pw_solid_mesh_find(mesh, 2, p->group, path, &g));
  PW_REQUIRE(g->nface > 0, PW_ERR_SCENE, "%s: the surface '%s' has no triangles", path, g->name);
  surface on = {.area = 0.0};
  pw_status status =
      pw_mem_alloc("traction: filled cells", sim->mesh.npatch, sizeof *on.filled, &on.filled);
  status = status == PW_OK ? pw_mem_alloc("traction: faces", g->nface, sizeof *on.face, &on.face)
                           : status;
  status = status == PW_OK ? find_faces(sim, mesh, g, l, &on) : status;
  if (status == PW_OK) {
    status = (p->follower ? create_follower : create_dead)(sim, mesh, g, &on, l);
  }
  pw_mem_free(&on.filled);
  pw_mem_free(&on.face);
  return status;
}

static void apply_traction(pw_implicit *sim, void *ctx, pw_real from, pw_real to)
{
  const load *l = ctx;
  const size_t nnode = (size_t)sim->mesh.tets.nnode;
  const pw_real part = pw_solid_course(sim, l->ramp->start_step, l->ramp->ramp_steps, to);
  (void)from;
  if (l->surface) {
    l->surface->pressure = part * ((const pw_traction_param *)l->param)->pressure_pa;
  }
  for (pw_idx i = 0; i < l->n; i++) {
    for (size_t c = 0; c < 3; c++) {
      sim->model.external[c * nnode + (size_t)l->node[i]] += part * l->force[3 * i + (pw_idx)c];
    }
  }
}

static void history_traction(const pw_implicit *sim, void *ctx, pw_record *row)
{
  const load *l = ctx;
  char name[64];
  pw_real sum[3];
  (void)sim;
  if (l->surface) {
    pw_tet_follow_sum(l->surface, sum);
  }
  for (int c = 0; c < 3; c++) {
    if (l->surface || l->sum[c] != 0.0) {
      snprintf(name, sizeof name, "traction_%d_force_%c_n", l->number, "xyz"[c]);
      pw_record_put(row, name, l->surface ? sum[c] : l->part * l->sum[c]);
    }
  }
}

static pw_status archive_surface(const pw_implicit *sim, load *l, pw_archive *ar)
{
  pw_tet_follow *f = l->surface;
  char name[64];
  snprintf(name, sizeof name, "traction_%d/x", l->number);
  PW_TRY(ar->real(ar, name, f->x, 3 * (pw_off)f->n));
  snprintf(name, sizeof name, "traction_%d/area", l->number);
  PW_TRY(ar->real(ar, name, f->area, 3 * (pw_off)f->n));
  snprintf(name, sizeof name, "traction_%d/pressure", l->number);
  PW_TRY(ar->real(ar, name, &f->pressure, 1));
  snprintf(name, sizeof name, "traction_%d/element", l->number);
  PW_TRY(ar->index(ar, name, f->elem, f->n));
  for (pw_idx i = 0; i < f->n; i++) {
    PW_REQUIRE(f->elem[i] >= 0 && f->elem[i] < sim->mesh.tets.nelem, PW_ERR_FILE,
               "the checkpoint's loaded surface is damaged");
  }
  return PW_OK;
}

static pw_status archive_load(pw_implicit *sim, void *ctx, pw_archive *ar)
{
  load *l = ctx;
  char name[64];
  const bool traction = l->force || l->surface;
  snprintf(name, sizeof name, "%s_%d/part", traction ? "traction" : "gravity", l->number);
  PW_TRY(ar->real(ar, name, &l->part, 1));
  return l->surface ? archive_surface(sim, l, ar) : PW_OK;
}

static pw_status create_gravity(pw_implicit *sim, const pw_solid_mesh *mesh, const void *param,
                                void **ctx)
{
  load *l;
  const pw_solid_gravity_param *p = param;
  (void)mesh;
  PW_TRY(pw_mem_alloc("gravity", 1, sizeof *l, &l));
  *ctx = l;
  l->param = param;
  l->ramp = &p->ramp;
  for (pw_idx i = 0; i < sim->model.points.n; i++) {
    for (int c = 0; c < 3; c++) {
      l->sum[c] += sim->model.points.mass[i] * p->acceleration_m_s2[c];
    }
  }
  return PW_OK;
}

static void apply_gravity(pw_implicit *sim, void *ctx, pw_real from, pw_real to)
{
  const load *l = ctx;
  const pw_solid_gravity_param *p = l->param;
  const pw_real part = pw_solid_course(sim, l->ramp->start_step, l->ramp->ramp_steps, to);
  pw_real g[3];
  (void)from;
  for (int c = 0; c < 3; c++) {
    g[c] = part * p->acceleration_m_s2[c];
  }
  pw_tet_model_gravity(&sim->model, g);
}

static void history_gravity(const pw_implicit *sim, void *ctx, pw_record *row)
{
  const load *l = ctx;
  char name[64];
  (void)sim;
  for (int c = 0; c < 3; c++) {
    if (l->sum[c] != 0.0) {
      snprintf(name, sizeof name, "weight_%c_n", "xyz"[c]);
      pw_record_put(row, name, l->part * l->sum[c]);
    }
  }
}

static const pw_solid_hooks traction_hooks = {
    .create = create_traction,
    .destroy = destroy,
    .apply = apply_traction,
    .moved = moved,
    .history = history_traction,
    .archive = archive_load,
};

static const pw_solid_hooks gravity_hooks = {
    .create = create_gravity,
    .destroy = destroy,
    .apply = apply_gravity,
    .moved = moved,
    .history = history_gravity,
    .archive = archive_load,
};

const pw_effect pw_effect_traction = {
    .name = "traction",
    .brief = "pressure, traction or force on a surface of the mesh",
    .many = true,
    .keys = traction_keys,
    .solid = &traction_hooks,
};

const pw_effect pw_effect_solid_gravity = {
    .name = "gravity",
    .brief = "weight of the points",
    .keys = gravity_keys,
    .solid = &gravity_hooks,
};
