/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/core/status.h"

#include <stdarg.h>
#include <stdio.h>

static _Thread_local char error_text[1024];
static _Thread_local char error_where[256];

const char *pw_status_text(pw_status s)
{
  switch (s) {
#define PW_STATUS(code, value, text)                                                               \
  case code:                                                                                       \
    return text;
#include "engine/core/status.def"
#undef PW_STATUS
  }
  return "unknown status";
}

pw_status pw_error_set(pw_status s, const char *file, int line, const char *func, const char *fmt,
                       ...)
{
  va_list args;
  va_start(args, fmt);
  vsnprintf(error_text, sizeof error_text, fmt, args);
  va_end(args);
  snprintf(error_where, sizeof error_where, "%s:%d %s", file, line, func);
  return s;
}

const char *pw_error_text(void)
{
  return error_text;
}

const char *pw_error_where(void)
{
  return error_where;
}

void pw_error_clear(void)
{
  error_text[0] = '\0';
  error_where[0] = '\0';
}
