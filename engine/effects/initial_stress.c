/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Stress of one body at the start: at rest under its own weight (K0), or uniform. */
#include "engine/effects/common.h"
#include "engine/effects/params.h"

#define AT(member) offsetof(pw_initial_stress_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"body", PW_KEY_BODY, AT(body), 0, 0, NULL, NULL, NULL, "body that starts with this stress"},
  {"kind", PW_KEY_CHOICE, AT(kind), 0, 0, "k0", "k0|uniform", NULL,
   "stress at rest under the body's own weight, or the same everywhere"},
  {"top_y_m", PW_KEY_REAL, AT(top_y_m), -1e6, 1e6, NULL, NULL, "kind=k0",
   "height of the free surface, where the vertical stress is -surcharge_pa"},
  {"k0", PW_KEY_REAL, AT(k0), 0, 100, NULL, NULL, "kind=k0",
   "horizontal over vertical stress"},
  {"surcharge_pa", PW_KEY_REAL, AT(surcharge_pa), 0, 1e12, "0", NULL, "kind=k0",
   "pressure on the free surface"},
  {"acceleration_m_s2", PW_KEY_REAL, AT(acceleration_m_s2), 0, 1e6, "0", NULL, "kind=k0",
   "weight per mass; 0: that of the gravity section"},
  {"stress_xx_pa", PW_KEY_REAL, AT(stress_xx_pa), -1e15, 1e15, NULL, NULL, "kind=uniform",
   "horizontal (axisymmetric: radial) stress, tension positive"},
  {"stress_yy_pa", PW_KEY_REAL, AT(stress_yy_pa), -1e15, 1e15, NULL, NULL, "kind=uniform",
   "vertical stress"},
  {"stress_zz_pa", PW_KEY_REAL, AT(stress_zz_pa), -1e15, 1e15, NULL, NULL, "kind=uniform",
   "out-of-plane (axisymmetric: hoop) stress"},
  {0}};
/* clang-format on */

static pw_real weight_per_mass(const pw_scene *scene, const pw_initial_stress_param *p)
{
  const pw_gravity_param *g = pw_scene_find_effect(scene, "gravity");
  return p->acceleration_m_s2 > 0.0 || !g ? p->acceleration_m_s2 : g->acceleration_m_s2;
}

static pw_status check(const pw_scene *scene, const void *param)
{
  const pw_initial_stress_param *p = param;
  const pw_scene_material *m = &scene->material[scene->body[p->body].material];
  PW_REQUIRE(m->model->takes_initial_stress, PW_ERR_SCENE,
             "material '%s' of body '%s' (%s) cannot start from a given stress", m->name,
             scene->body[p->body].name, m->model->name);
  PW_REQUIRE(p->kind != PW_STRESS_K0 || weight_per_mass(scene, p) > 0.0, PW_ERR_SCENE,
             "kind k0 needs acceleration_m_s2 or a gravity section");
  return PW_OK;
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  const pw_initial_stress_param *p = param;
  const pw_body *b = &sim->body[p->body];
  pw_points *pt = &sim->points;
  const pw_real unit_weight =
      pw_scene_density(&sim->scene, p->body) * weight_per_mass(&sim->scene, p);
  for (pw_idx i = 0; i < pt->n; i++) {
    if (pt->body[i] != p->body) {
      continue;
    }
    pw_real depth = pw_max(p->top_y_m - pt->x[pt->ld + i], 0.0);
    pw_real yy = -(p->surcharge_pa + unit_weight * depth);
    bool k0 = p->kind == PW_STRESS_K0;
    pt->stress[i] = k0 ? p->k0 * yy : p->stress_xx_pa;
    pt->stress[pt->ld + i] = k0 ? yy : p->stress_yy_pa;
    pt->stress[2 * pt->ld + i] = k0 ? p->k0 * yy : p->stress_zz_pa;
    for (int c = 3; c < 6; c++) {
      pt->stress[c * pt->ld + i] = 0.0;
    }
    if (b->model->init) {
      b->model->init(b->param, 1, pt->ld, pt->stress + i, pt->state ? pt->state + i : NULL);
    }
  }
  *ctx = NULL;
  return PW_OK;
}

const pw_effect pw_effect_initial_stress = {
    .name = "initial_stress",
    .brief = "stress of a body at the start: at rest (K0) or uniform",
    .keys = keys,
    .check = check,
    .create = create,
};
