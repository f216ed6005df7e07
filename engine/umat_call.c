/* SPDX-License-Identifier: GPL-3.0-or-later */
/* A call of a user's routine that may end in a STOP. The exits of gfortran's runtime are defined
 * here too: the program's own symbols come before those of libgfortran, so that a routine that
 * stops comes back to the call it is in. */
#include "engine/umat.h"

#include <omp.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* The arguments of SUBROUTINE UMAT; the last is the length of CMNAME, as Fortran passes it. */
typedef void umat_routine(pw_real *, pw_real *, pw_real *, pw_real *, pw_real *, pw_real *,
                          pw_real *, pw_real *, pw_real *, pw_real *, pw_real *, pw_real *,
                          pw_real *, pw_real *, pw_real *, pw_real *, pw_real *, pw_real *, char *,
                          int32_t *, int32_t *, int32_t *, int32_t *, pw_real *, int32_t *,
                          pw_real *, pw_real *, pw_real *, pw_real *, pw_real *, pw_real *,
                          int32_t *, int32_t *, int32_t *, int32_t *, int32_t *, int32_t *, size_t);

enum { TEXTS = 16, TEXT = 200 };

/* Where the call of this thread began, and why it gave up. */
static _Thread_local struct {
  jmp_buf start;
  bool armed;
  char text[TEXT];
} guard;

static omp_lock_t calls, texts;
static bool have_locks;

/* Texts of failures that have occurred; kept, since errors refer to them. */
static char kept[TEXTS][TEXT];
static int nkept;

void pw_umat_locks_create(void)
{
  if (!have_locks) {
    omp_init_lock(&calls);
    omp_init_lock(&texts);
    have_locks = true;
  }
}

void pw_umat_enter(void)
{
  omp_set_lock(&calls);
}

void pw_umat_leave(void)
{
  omp_unset_lock(&calls);
}

static const char *keep(const char *text)
{
  const char *found = "the UMAT stopped";
  omp_set_lock(&texts);
  int i = 0;
  while (i < nkept && strcmp(kept[i], text) != 0) {
    i++;
  }
  if (i == nkept && nkept < TEXTS) {
    strcpy(kept[nkept++], text);
  }
  found = i < nkept ? kept[i] : found;
  omp_unset_lock(&texts);
  return found;
}

const char *pw_umat_call_guarded(const pw_umat *u, pw_umat_call *c)
{
  umat_routine *umat;
  memcpy(&umat, &u->entry, sizeof umat);
  guard.armed = true;
  if (setjmp(guard.start) != 0) {
    guard.armed = false;
    return keep(guard.text);
  }
  umat(c->stress, c->statev, c->ddsdde, &c->sse, &c->spd, &c->scd, &c->rpl, c->ddsddt, c->drplde,
       &c->drpldt, c->stran, c->dstran, c->time, &c->dtime, &c->temp, &c->dtemp, &c->predef,
       &c->dpred, c->cmname, &c->ndi, &c->nshr, &c->ntens, &c->nstatv, c->props, &c->nprops,
       c->coords, c->drot, &c->pnewdt, &c->celent, c->dfgrd0, c->dfgrd1, &c->noel, &c->npt,
       &c->layer, &c->kspt, c->kstep, &c->kinc, sizeof c->cmname);
  guard.armed = false;
  return NULL;
}

_Noreturn void pw_umat_give_up(const char *why, const char *text, size_t length)
{
  if (!guard.armed) {
    __builtin_trap(); /* not called by a routine that was called here: nowhere to go */
  }
  while (text && length > 0 && (text[length - 1] == ' ' || text[length - 1] == '\n')) {
    length--;
  }
  const int shown = text ? (int)(length < TEXT / 2 ? length : TEXT / 2) : 0;
  snprintf(guard.text, sizeof guard.text, "the UMAT %s%s%.*s", why, shown > 0 ? ": " : "", shown,
           shown > 0 ? text : "");
  longjmp(guard.start, 1);
}

_Noreturn void _gfortran_stop_string(const char *text, size_t length, bool quiet);
_Noreturn void _gfortran_stop_numeric(int code, bool quiet);
_Noreturn void _gfortran_error_stop_string(const char *text, size_t length, bool quiet);
_Noreturn void _gfortran_error_stop_numeric(int code, bool quiet);
_Noreturn void _gfortran_exit_i4(int32_t *code);
_Noreturn void _gfortran_exit_i8(int64_t *code);
_Noreturn void _gfortran_abort(void);
_Noreturn void _gfortran_runtime_error(const char *format, ...)
    __attribute__((format(printf, 1, 2)));
_Noreturn void _gfortran_runtime_error_at(const char *where, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

void _gfortran_stop_string(const char *text, size_t length, bool quiet)
{
  (void)quiet;
  pw_umat_give_up("ended with STOP", text, length);
}

void _gfortran_error_stop_string(const char *text, size_t length, bool quiet)
{
  (void)quiet;
  pw_umat_give_up("ended with ERROR STOP", text, length);
}

static _Noreturn void stop_numeric(int code)
{
  char text[16];
  int n = snprintf(text, sizeof text, "%d", code);
  pw_umat_give_up("ended with STOP", text, (size_t)n);
}

void _gfortran_stop_numeric(int code, bool quiet)
{
  (void)quiet;
  stop_numeric(code);
}

void _gfortran_error_stop_numeric(int code, bool quiet)
{
  (void)quiet;
  stop_numeric(code);
}

void _gfortran_exit_i4(int32_t *code)
{
  stop_numeric(code ? *code : 0);
}

void _gfortran_exit_i8(int64_t *code)
{
  stop_numeric(code ? (int)*code : 0);
}

void _gfortran_abort(void)
{
  pw_umat_give_up("called ABORT", NULL, 0);
}

static _Noreturn void runtime_error(const char *format, va_list list)
{
  char text[TEXT];
  int n = vsnprintf(text, sizeof text, format, list);
  pw_umat_give_up("broke a rule of Fortran", text,
                  n < 0                     ? 0
                  : (size_t)n < sizeof text ? (size_t)n
                                            : sizeof text - 1);
}

void _gfortran_runtime_error(const char *format, ...)
{
  va_list list;
  va_start(list, format);
  runtime_error(format, list);
}

void _gfortran_runtime_error_at(const char *where, const char *format, ...)
{
  va_list list;
  (void)where;
  va_start(list, format);
  runtime_error(format, list);
}
