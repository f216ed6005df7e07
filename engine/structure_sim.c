/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/structure_sim.h"

#include <math.h>

#include "engine/core/mem.h"

/* Pieces of a surface: a quarter of a cell, and short enough on curved parts that the sagitta
 * s^2 / (8 R) of a piece is less than a thousandth of the radius. */
static pw_real segment_of(const pw_scene *scene, const pw_scene_body *b)
{
  pw_real segment = 0.25 * scene->grid.cell_m;
  if (b->surface_segment_m > 0.0) {
    return b->surface_segment_m;
  }
  if (b->shape == PW_SHAPE_DISC) {
    segment = pw_min(segment, b->radius_m / 16.0);
  }
  if (b->shape == PW_SHAPE_PILE && b->tip == PW_TIP_ROUNDED) {
    pw_real height = b->tip_length_m > 0.0 ? b->tip_length_m : b->radius_m;
    segment = pw_min(segment, pw_min(b->radius_m, height) / 16.0);
  }
  return segment;
}

pw_status pw_structures_create(pw_sim *sim)
{
  const pw_scene *scene = &sim->scene;
  int count = 0;
  for (int b = 0; b < scene->nbody; b++) {
    count += scene->body[b].kind != PW_BODY_POINTS;
  }
  PW_TRY(pw_mem_alloc("structures", count, sizeof(pw_structure), &sim->structure));
  for (int b = 0; b < scene->nbody; b++) {
    if (scene->body[b].kind != PW_BODY_POINTS) {
      pw_structure *s = &sim->structure[sim->nstructure];
      PW_TRY(pw_structure_create(scene, b, segment_of(scene, &scene->body[b]), s));
      sim->structure_of[b] = s;
      sim->nstructure++;
    }
  }
  return PW_OK;
}

void pw_structures_destroy(pw_sim *sim)
{
  for (int k = 0; k < sim->nstructure; k++) {
    pw_structure_destroy(&sim->structure[k]);
  }
  pw_mem_free(&sim->structure);
}

void pw_structures_clear(pw_sim *sim)
{
  for (int k = 0; k < sim->nstructure; k++) {
    pw_structure_clear(&sim->structure[k]);
  }
}

void pw_structures_kick(pw_sim *sim)
{
  for (int k = 0; k < sim->nstructure; k++) {
    pw_structure *s = &sim->structure[k];
    const pw_body *b = &sim->body[s->body];
    pw_structure_kick(s, sim->dt, b->prescribed ? b->prescribed_v : NULL);
  }
}

void pw_structures_drift(pw_sim *sim)
{
  for (int k = 0; k < sim->nstructure; k++) {
    pw_structure *s = &sim->structure[k];
    pw_real strain = pw_structure_strain(s);
    pw_structure_drift(s, sim->dt);
    sim->energy.strain_work += sim->measure * (pw_structure_strain(s) - strain);
    sim->energy.external += sim->measure * (s->work + s->given_work);
  }
}

pw_real pw_structures_kinetic(const pw_sim *sim)
{
  pw_real sum = 0.0;
  for (int k = 0; k < sim->nstructure; k++) {
    sum += sim->measure * pw_structure_kinetic(&sim->structure[k]);
  }
  return sum;
}

pw_real pw_structures_speed(const pw_sim *sim)
{
  pw_real speed2 = 0.0;
  for (int k = 0; k < sim->nstructure; k++) {
    const pw_interface *line = &sim->structure[k].line;
    for (pw_idx i = 0; i < line->n; i++) {
      const pw_real *v = line->node[i].v, v2 = v[0] * v[0] + v[1] * v[1];
      speed2 = v2 <= speed2 ? speed2 : v2; /* a NaN stays to be seen */
    }
  }
  return sqrt(speed2);
}

pw_status pw_structures_archive(pw_sim *sim, pw_archive *ar)
{
  for (int k = 0; k < sim->nstructure; k++) {
    PW_TRY(pw_structure_archive(&sim->structure[k], ar));
  }
  return PW_OK;
}

pw_status pw_structure_check(const pw_scene *scene, int body)
{
  static const char *const kind[] = {"points", "rigid", "rod"};
  const pw_scene_body *b = &scene->body[body];
  const bool rod = b->kind == PW_BODY_ROD;
  if (b->kind == PW_BODY_POINTS) {
    return PW_OK;
  }
  PW_REQUIRE(rod ? b->shape == PW_SHAPE_PILE : b->shape != PW_SHAPE_RING, PW_ERR_SCENE,
             "shape: a body of kind %s is %s", kind[b->kind],
             rod ? "a pile" : "a pile, a disc or a rectangle");
  PW_REQUIRE(b->nrefine == 0, PW_ERR_SCENE, "refine: a body of kind %s has no points",
             kind[b->kind]);
  const pw_scene_material *m = &scene->material[b->material];
  PW_REQUIRE(!rod || !m->model || m->model == pw_material_find("linear_elastic"), PW_ERR_SCENE,
             "material: a rod is linear_elastic, '%s' is %s", m->name, m->model->name);
  PW_REQUIRE(b->surface_segment_m <= scene->grid.cell_m * (1.0 + 1e-9), PW_ERR_SCENE,
             "surface_segment_m = %g m must not be longer than a cell, %g m", b->surface_segment_m,
             scene->grid.cell_m);
  PW_REQUIRE(!rod || b->rod_elements >= 1, PW_ERR_SCENE, "rod_elements: %d, at least 1 is needed",
             b->rod_elements);
  PW_REQUIRE(b->velocity_m_s[0] == 0.0 || (!rod && scene->geometry != PW_AXI), PW_ERR_SCENE,
             "velocity_m_s: %s moves along y only", rod ? "a rod" : "in axisymmetry a rigid body");
  return PW_OK;
}
