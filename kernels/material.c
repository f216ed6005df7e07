/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/material.h"

#include <string.h>

#define PW_MATERIAL(symbol) extern const pw_material symbol;
#include "kernels/materials.def"
#undef PW_MATERIAL

static const pw_material *const materials[] = {
#define PW_MATERIAL(symbol) &symbol,
#include "kernels/materials.def"
#undef PW_MATERIAL
};

const pw_material *pw_material_at(int i)
{
  int count = (int)(sizeof materials / sizeof materials[0]);
  return i >= 0 && i < count ? materials[i] : NULL;
}

const pw_material *pw_material_find(const char *name)
{
  for (int i = 0; pw_material_at(i); i++) {
    if (strcmp(materials[i]->name, name) == 0) {
      return materials[i];
    }
  }
  return NULL;
}
