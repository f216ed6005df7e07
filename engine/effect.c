/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/effect.h"

#include <string.h>

#define PW_EFFECT(symbol) extern const pw_effect symbol;
#include "engine/effects.def"
#undef PW_EFFECT

static const pw_effect *const effects[] = {
#define PW_EFFECT(symbol) &symbol,
#include "engine/effects.def"
#undef PW_EFFECT
};

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
