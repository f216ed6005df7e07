/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "kernels/umat.h"

#include <string.h>

static pw_umat table[PW_UMAT_LIBRARIES];
static int count;

const pw_umat *pw_umat_find(const char *file, const char *symbol)
{
  for (int i = 0; i < count; i++) {
    if (strcmp(table[i].file, file) == 0 && strcmp(table[i].symbol, symbol) == 0) {
      return &table[i];
    }
  }
  return NULL;
}

bool pw_umat_add(const pw_umat *umat)
{
  if (count == PW_UMAT_LIBRARIES) {
    return false;
  }
  table[count++] = *umat;
  return true;
}

const char *pw_umat_text(const pw_real *param, int index)
{
  return (const char *)(param + index);
}
