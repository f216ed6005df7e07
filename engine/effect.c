/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effect.h"

#include <string.h>

#define PW_EFFECT(symbol) extern const pw_effect symbol;
#include "engine/effects.def"
#include "engine/solid_effects.def"
#undef PW_EFFECT

static const pw_effect *const effects[] = {
#define PW_EFFECT(symbol) &symbol,
#include "engine/effects.def"
#undef PW_EFFECT
};

static const pw_effect *const solid_effects[] = {
#define PW_EFFECT(symbol) &symbol,
#include "engine/solid_effects.def"
#undef PW_EFFECT
};

const pw_effect *pw_solid_effect_at(int i)
{
  int count = (int)(sizeof solid_effects / sizeof solid_effects[0]);
  return i >= 0 && i < count ? solid_effects[i] : NULL;
}

const pw_effect *pw_effect_at(int i)
{
  int count = (int)(sizeof effects / sizeof effects[0]);
  return i >= 0 && i < count ? effects[i] : NULL;
}

const pw_effect *pw_effect_find(const char *name)
{
  for (int i = 0; pw_effect_at(i); i++) {
    if (strcmp(effects[i]->name, name) == 0) {
      return effects[i];
    }
  }
  return NULL;
}

const pw_effect *pw_effect_of(const pw_scene *scene, const char *name)
{
  if (scene->geometry != PW_SOLID) {
    return pw_effect_find(name);
  }
  for (int i = 0; pw_solid_effect_at(i); i++) {
    if (strcmp(solid_effects[i]->name, name) == 0) {
      return solid_effects[i];
    }
  }
  return NULL;
}
