/* SPDX-License-Identifier: GPL-3.0-or-later */
/* F-bar (engine/fbar.h): the passes over points ask sim->fbar; the effect itself has no hooks. */
#include "engine/fbar.h"

#include "engine/core/mem.h"
#include "engine/effects/common.h"
#include "engine/effects/params.h"

#define AT(member) offsetof(pw_fbar_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"body", PW_KEY_BODY, AT(body), 0, 0, "", NULL, NULL,
   "body whose points share the volume change of their cell; absent: every body"},
  {0}};
/* clang-format on */

static void destroy(void **ctx)
{
  pw_fbar_cells *c = *ctx;
  if (c) {
    pw_mem_free(&c->du);
    pw_mem_free(&c->element);
    pw_mem_free(&c->sum);
    pw_mem_free(&c->stress);
  }
  pw_mem_free(ctx);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  pw_fbar_cells *c;
  const pw_fbar_param *p = param;
  pw_points *points = &sim->points;
  PW_TRY(pw_mem_alloc("fbar", 1, sizeof *c, &c));
  *ctx = c;
  for (int b = 0; b < sim->nbody; b++) {
    c->body[b] = p->body < 0 || p->body == b;
  }
  PW_TRY(pw_mem_alloc("fbar gradients", 5 * (pw_off)points->ld, sizeof(pw_real), &c->du));
  PW_TRY(pw_mem_alloc("fbar cells", points->ld, sizeof(pw_idx), &c->element));
  PW_TRY(pw_mem_alloc("fbar volumes", 2 * (pw_off)sim->nbody * sim->mesh.nelem, sizeof(pw_real),
                      &c->sum));
  PW_TRY(pw_mem_alloc("fbar stress", 6 * (pw_off)points->ld, sizeof(pw_real), &c->stress));
  for (pw_idx i = 0; i < points->ld; i++) {
    points->volume_ratio[i] = 1.0;
    c->element[i] = -1;
  }
  sim->fbar = c;
  sim->transfer.stress = c->stress;
  return PW_OK;
}

static const pw_hook hooks[] = {{0, NULL}};

const pw_effect pw_effect_fbar = {
    .name = "fbar",
    .brief = "points of a cell share one volume change (F-bar), against volumetric locking",
    .point_fields = PW_FIELD_BIT(PW_FIELD_VOLUME_RATIO),
    .keys = keys,
    .hooks = hooks,
    .create = create,
    .destroy = destroy,
};
