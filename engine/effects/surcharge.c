/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Pressure on one side of a body. */
#include "engine/effects/common.h"
#include "engine/effects/load_curve.h"
#include "engine/effects/params.h"
#include "engine/effects/surface_load.h"

#include "engine/core/mem.h"

#define AT(member) offsetof(pw_surcharge_param, member)

/* clang-format off */
static const pw_key keys[] = {
  {"body", PW_KEY_BODY, AT(body), 0, 0, NULL, NULL, NULL, "loaded body"},
  {"side", PW_KEY_CHOICE, AT(side), 0, 0, "top", "bottom|top|left|right", NULL,
   "loaded side of the body at the start"},
  {"pressure_pa", PW_KEY_REAL, AT(pressure_pa), -1e15, 1e15, NULL, NULL, NULL,
   "pressure, positive towards the body"},
  {"ramp_s", PW_KEY_REAL, AT(ramp_s), 0, 1e12, "0", NULL, NULL,
   "time over which it grows linearly from zero; 0: at once"},
  {"start_s", PW_KEY_REAL, AT(start_s), 0, 1e12, "0", NULL, NULL, "time at which it begins"},
  {0}};
/* clang-format on */

typedef struct surcharge {
  const pw_surcharge_param *param;
  pw_surface_load load;
  bool on; /* forces were applied in this step */
} surcharge;

static pw_status add_force(pw_sim *sim, void *ctx)
{
  surcharge *c = ctx;
  pw_real factor = pw_effect_ramp(sim, c->param->start_s, c->param->ramp_s);
  c->on = factor > 0.0;
  if (c->on) {
    pw_surface_load_apply(sim, &c->load, c->param->pressure_pa * factor);
  }
  return PW_OK;
}

static pw_status add_work(pw_sim *sim, void *ctx)
{
  const surcharge *c = ctx;
  if (c->on) {
    sim->energy.external += pw_surface_load_work(sim, &c->load);
  }
  return PW_OK;
}

static void destroy(void **ctx)
{
  surcharge *c = *ctx;
  if (c) {
    pw_surface_load_destroy(&c->load);
  }
  pw_mem_free(ctx);
}

static pw_status create(pw_sim *sim, const void *param, void **ctx)
{
  surcharge *c;
  PW_TRY(pw_mem_alloc("surcharge", 1, sizeof *c, &c));
  *ctx = c;
  c->param = param;
  return pw_surface_load_create(sim, c->param->body, c->param->side, &c->load);
}

static const pw_hook hooks[] = {
    {PW_STAGE_NODE_FORCE, add_force},
    {PW_STAGE_END, add_work},
    {0, NULL},
};

const pw_effect pw_effect_surcharge = {
    .name = "surcharge",
    .brief = "pressure on one side of a body",
    .many = true,
    .keys = keys,
    .hooks = hooks,
    .implicit = hooks,
    .create = create,
    .destroy = destroy,
};
