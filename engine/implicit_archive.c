/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The state of an implicit simulation on its way to or from a checkpoint. Trial values, forces and
 * tables of points by element follow from it at the next step. */
#include "engine/implicit_state.h"

#include <string.h>

#include "engine/newton_archive.h"
#include "engine/scene_hash.h"

/* A mesh made anew from a geometry must be the same one. */
static uint64_t mesh_hash(const pw_tet_mesh *m)
{
  uint64_t hash = UINT64_C(0xcbf29ce484222325);
  pw_hash_bytes(&hash, m->tets.x, 3 * (size_t)m->tets.nnode * sizeof *m->tets.x);
  pw_hash_bytes(&hash, m->tets.node, 4 * (size_t)m->tets.nelem * sizeof *m->tets.node);
  return hash;
}

static pw_status archive_identity(pw_implicit *sim, pw_archive *ar)
{
  const uint64_t scene = pw_scene_hash(&sim->scene), mesh = mesh_hash(&sim->mesh);
  const pw_idx want[8] = {sim->model.points.n,         sim->mesh.tets.nnode,
                          sim->mesh.tets.nelem,        sim->model.points.nstate,
                          (pw_idx)(mesh & INT32_MAX),  (pw_idx)(mesh >> 33),
                          (pw_idx)(scene & INT32_MAX), (pw_idx)(scene >> 33)};
  pw_idx have[8];
  memcpy(have, want, sizeof have);
  PW_TRY(ar->index(ar, "implicit/identity", have, 8));
  PW_REQUIRE(memcmp(have, want, 4 * sizeof have[0]) == 0, PW_ERR_FILE,
             "the checkpoint belongs to another scene: it has %d points, %d nodes and %d elements, "
             "the scene %d, %d and %d",
             have[0], have[1], have[2], want[0], want[1], want[2]);
  PW_REQUIRE(memcmp(have, want, 6 * sizeof have[0]) == 0, PW_ERR_FILE,
             "the checkpoint belongs to a scene with another mesh");
  PW_REQUIRE(memcmp(have, want, sizeof have) == 0, PW_ERR_FILE,
             "the checkpoint belongs to a scene with other parameters; only outputs may differ");
  return PW_OK;
}

static pw_status archive_points(pw_implicit *sim, pw_archive *ar)
{
  pw_tet_points *p = &sim->model.points;
  const pw_off n = p->ld;
  const struct {
    const char *name;
    pw_real *value;
    int components;
  } fields[] = {
      {"points/x", p->x, 3},
      {"points/volume", p->volume, 1},
      {"points/jac", p->jac, 1},
      {"points/jac_bar", p->jac_bar, 1},
      {"points/stress", p->stress, 6},
      {"points/state", p->state, p->nstate},
      {"points/left_cg", p->left_cg, 6},
      {"points/def_grad", p->def_grad, 9},
      {"points/velocity", p->velocity, 3},
      {"points/acceleration", p->acceleration, 3},
  };
  for (size_t k = 0; k < sizeof fields / sizeof fields[0]; k++) {
    if (fields[k].value && fields[k].components > 0) {
      PW_TRY(ar->real(ar, fields[k].name, fields[k].value, n * fields[k].components));
    }
  }
  PW_TRY(ar->index(ar, "points/element", p->elem, n));
  for (pw_idx i = 0; ar->loading && i < p->n; i++) {
    PW_REQUIRE(p->elem[i] >= 0 && p->elem[i] < sim->mesh.tets.nelem, PW_ERR_FILE,
               "the checkpoint's points are damaged");
  }
  return PW_OK;
}

static pw_status archive_counts(pw_implicit *sim, pw_archive *ar)
{
  pw_walk_counts *w = &sim->walked, *last = &sim->model.walked;
  pw_off report[3] = {sim->report.iterations, sim->report.cuts, sim->report.parts};
  pw_off *const count[] = {&sim->step, &sim->iterations, &sim->cuts,   &sim->parts,
                           &w->points, &w->tests,        &w->moved,    &w->ties,
                           &w->binned, &last->points,    &last->tests, &sim->model.step,
                           &report[0], &report[1],       &report[2],   &sim->equations};
  enum { COUNTS = sizeof count / sizeof count[0] };
  pw_off values[COUNTS];
  for (int k = 0; k < COUNTS; k++) {
    values[k] = *count[k];
  }
  PW_TRY(ar->offset(ar, "implicit/counts", values, COUNTS));
  for (int k = 0; k < COUNTS; k++) {
    *count[k] = values[k];
  }
  sim->report.iterations = (int)report[0];
  sim->report.cuts = (int)report[1];
  sim->report.parts = (int)report[2];
  pw_real number[3] = {sim->now, sim->wanted, 0.0};
  number[2] = sim->report.count > 0 ? sim->report.residual[sim->report.count - 1] : 0.0;
  PW_TRY(ar->real(ar, "implicit/numbers", number, 3));
  if (ar->loading) {
    sim->now = number[0];
    sim->wanted = number[1];
    sim->report.count = 1;
    sim->report.residual[0] = number[2];
  }
  return PW_OK;
}

/* The mesh stands where its effect has it after the steps made. */
static pw_status place_mesh(pw_implicit *sim)
{
  for (int k = 0; k < sim->neffect && sim->step > 0; k++) {
    const pw_solid_hooks *hooks = sim->effect[k].type->solid;
    if (hooks->mesh) {
      PW_TRY(hooks->mesh(sim, sim->effect[k].ctx, sim->now));
    }
  }
  return PW_OK;
}

pw_status pw_implicit_archive(pw_implicit *sim, pw_archive *ar)
{
  PW_TRY(archive_identity(sim, ar));
  PW_TRY(archive_counts(sim, ar));
  PW_TRY(archive_points(sim, ar));
  PW_TRY(pw_newton_archive(sim->newton, ar));
  for (int k = 0; k < sim->neffect; k++) {
    if (sim->effect[k].type->solid->archive) {
      PW_TRY(sim->effect[k].type->solid->archive(sim, sim->effect[k].ctx, ar));
    }
  }
  return ar->loading ? place_mesh(sim) : PW_OK;
}
