/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/core/record.h"

#include <stdio.h>

static pw_record_item *append(pw_record *r, const char *name)
{
  r->asked = r->n == 0 ? 1 : r->asked + 1;
  if (r->n == PW_RECORD_MAX) {
    return NULL;
  }
  pw_record_item *item = &r->item[r->n++];
  *item = (pw_record_item){0};
  snprintf(item->name, sizeof item->name, "%s", name);
  return item;
}

void pw_record_put(pw_record *r, const char *name, pw_real value)
{
  pw_record_item *item = append(r, name);
  if (item) {
    item->value = value;
  }
}

void pw_record_put_array(pw_record *r, const char *name, const pw_real *array, int count)
{
  pw_record_item *item = append(r, name);
  if (item) {
    item->array = array;
    item->count = count;
  }
}
