/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/umat.h"

#include <ctype.h>
#include <dlfcn.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/** The routine of that name in any of the ways compilers write it, or NULL. */
static void *find_routine(void *library, const char *name)
{
  char lower[PW_NAME], fortran[PW_NAME + 1];
  snprintf(lower, sizeof lower, "%s", *name ? name : "umat");
  void *routine = *name ? dlsym(library, name) : NULL;
  for (char *c = lower; *c; c++) {
    *c = (char)tolower((unsigned char)*c);
  }
  snprintf(fortran, sizeof fortran, "%s_", lower);
  routine = routine ? routine : dlsym(library, fortran);
  return routine ? routine : dlsym(library, lower);
}

static pw_status open_library(const char *file, void **library)
{
  char path[PW_FILE_NAME + 2]; /* a name without a folder is of the working folder */
  snprintf(path, sizeof path, "%s%s", strchr(file, '/') ? "" : "./", file);
  PW_REQUIRE(access(path, F_OK) == 0, PW_ERR_SCENE, "library: there is no file %s", file);
  *library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  const char *why = *library ? "" : dlerror();
  PW_REQUIRE(*library, PW_ERR_SCENE,
             "library: cannot load it: %s (of Abaqus' own routines a library may call %s)",
             why ? why : file, pw_umat_utilities);
  return PW_OK;
}

pw_status pw_umat_load(const pw_real *param)
{
  pw_umat u = {.call = pw_umat_call_guarded, .enter = pw_umat_enter, .leave = pw_umat_leave};
  void *library = NULL;
  snprintf(u.file, sizeof u.file, "%s", pw_umat_text(param, PW_UMAT_FILE));
  snprintf(u.symbol, sizeof u.symbol, "%s", pw_umat_text(param, PW_UMAT_SYMBOL));
  if (pw_umat_find(u.file, u.symbol)) {
    return PW_OK;
  }
  PW_TRY(open_library(u.file, &library));
  void *routine = find_routine(library, u.symbol);
  if (!routine) {
    dlclose(library);
  }
  PW_REQUIRE(routine || *u.symbol, PW_ERR_SCENE,
             "library: there is neither umat_ nor umat in %s; 'symbol' can name another routine",
             u.file);
  PW_REQUIRE(
      routine, PW_ERR_SCENE,
      "symbol: there is no routine %s in %s (nor with small letters or an underscore behind)",
      u.symbol, u.file);
  memcpy(&u.entry, &routine, sizeof routine); /* POSIX: a function's address */
  pw_umat_locks_create();
  PW_REQUIRE(pw_umat_add(&u), PW_ERR_SCENE, "library: more than %d routines are loaded",
             (int)PW_UMAT_LIBRARIES);
  return PW_OK;
}
