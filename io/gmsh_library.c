/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/gmsh_library.h"

#ifdef PW_GMSH_LIBRARY

#include <ctype.h>
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "engine/core/mem.h"
#include "engine/threads.h"
#include "io/atomic_file.h"

enum { MAX_NUMBERS = 16 };

static pw_gmsh_library gmsh;
static int threads; /* OpenMP's choice before gmsh was started, which sets it to one */

static pw_status load_library(void)
{
  if (gmsh.handle) {
    return PW_OK;
  }
  void *handle = dlopen(PW_GMSH_LIBRARY, RTLD_NOW | RTLD_LOCAL), *symbol = NULL;
  PW_REQUIRE(handle, PW_ERR_UNSUPPORTED, "gmsh cannot be loaded: %s", dlerror());
#define LOAD(name)                                                                                 \
  symbol = dlsym(handle, #name);                                                                   \
  PW_REQUIRE(symbol, PW_ERR_UNSUPPORTED, "gmsh has no function %s", #name);                        \
  memcpy(&gmsh.name, &symbol, sizeof symbol);
  PW_GMSH_CALLS(LOAD)
  gmsh.handle = handle;
  return PW_OK;
}

/* gmsh would take other files for scripts and run them. */
static pw_status check_file(const char *path)
{
  char head[12] = "";
  FILE *file = fopen(path, "rb");
  PW_REQUIRE(file, PW_ERR_FILE, "%s: cannot be opened", path);
  size_t n = fread(head, 1, sizeof head - 1, file);
  fclose(file);
  PW_REQUIRE(n == sizeof head - 1 && memcmp(head, "$MeshFormat", n) == 0, PW_ERR_FILE,
             "%s: no gmsh mesh: it does not begin with $MeshFormat", path);
  return PW_OK;
}

/* "n=8 width=0.1" as gmsh's arguments -setnumber n 8 -setnumber width 0.1. */
static pw_status split_numbers(char *text, char **argument, int *count)
{
  static char option[] = "-setnumber";
  char *rest = text, *word;
  while ((word = strtok_r(rest, " ,", &rest)) != NULL) {
    char *equals = strchr(word, '='), *end = NULL;
    PW_REQUIRE(equals && equals > word, PW_ERR_SCENE, "mesh.numbers: '%s' is not name=number",
               word);
    PW_REQUIRE(strtod(equals + 1, &end) == strtod(equals + 1, NULL) && end > equals + 1 && !*end,
               PW_ERR_SCENE, "mesh.numbers: '%s' is no number", equals + 1);
    PW_REQUIRE(*count + 3 <= 1 + 3 * MAX_NUMBERS, PW_ERR_SCENE, "mesh.numbers: at most %d",
               (int)MAX_NUMBERS);
    *equals = '\0';
    argument[(*count)++] = option;
    argument[(*count)++] = word;
    argument[(*count)++] = equals + 1;
  }
  return PW_OK;
}

static bool in_word(char c)
{
  return isalnum((unsigned char)c) || c == '_';
}

static bool has_word(const char *text, const char *word)
{
  const size_t length = strlen(word);
  bool found = false;
  for (const char *at = strstr(text, word); at && !found; at = strstr(at + 1, word)) {
    found = (at == text || !in_word(at[-1])) && !in_word(at[length]);
  }
  return found;
}

/* gmsh is silent about a number that its script never asks for. Scripts may take in others, which
 * are not looked at. */
static pw_status check_names(const pw_gmsh_recipe *recipe, char *const *argument, int count)
{
  pw_status status = PW_OK;
  long size = 0;
  char *text = NULL;
  FILE *file = fopen(recipe->path, "rb");
  if (file && fseek(file, 0, SEEK_END) == 0 && (size = ftell(file)) >= 0) {
    rewind(file);
    status = pw_mem_alloc("geometry script", size + 1, 1, &text);
    size = text ? (long)fread(text, 1, (size_t)size, file) : 0;
  }
  if (file) {
    fclose(file);
  }
  const bool whole = text && !has_word(text, "Include") && !has_word(text, "Merge");
  const char *missing = NULL;
  for (int k = 1; k < count && whole && !missing; k += 3) { /* -setnumber, name, value */
    missing = has_word(text, argument[k + 1]) ? NULL : argument[k + 1];
  }
  pw_mem_free(&text);
  PW_TRY(status);
  PW_REQUIRE(!missing, PW_ERR_SCENE, "mesh.numbers: the name '%s' does not occur in %s", missing,
             recipe->path);
  return PW_OK;
}

static pw_status initialize(const pw_gmsh_recipe *recipe)
{
  static char program[] = "gmsh";
  char text[256] = "", *argument[2 + 3 * MAX_NUMBERS] = {program};
  int count = 1, failed = 0;
  if (recipe) {
    snprintf(text, sizeof text, "%s", recipe->numbers);
    PW_TRY(split_numbers(text, argument, &count));
    PW_TRY(check_names(recipe, argument, count));
  }
  threads = pw_threads_default();
  gmsh.gmshInitialize(count, argument, 0, &failed);
  if (failed) {
    pw_threads_set_default(threads);
  }
  PW_REQUIRE(!failed, PW_ERR_UNSUPPORTED, "gmsh cannot be started");
  gmsh.gmshOptionSetNumber("General.Terminal", 0.0, &failed); /* no messages */
  gmsh.gmshOptionSetNumber("General.NumThreads", 1.0, &failed);
  return PW_OK;
}

static pw_status refused(const char *path, const char *what)
{
  char *why = NULL;
  int failed = 0;
  gmsh.gmshLoggerGetLastError(&why, &failed);
  pw_error_set(PW_ERR_SCENE, __FILE__, __LINE__, __func__, "mesh.file: %s: gmsh cannot %s it%s%s",
               path, what, why && *why ? ": " : "", why ? why : "");
  gmsh.gmshFree(why);
  return PW_ERR_SCENE;
}

/* What is not in a physical group, and points that only helped to draw, do not come back from a
 * file. */
static pw_status write_and_reopen(const char *path)
{
  const char *place = getenv("TMPDIR");
  char folder[PW_PATH], file[PW_PATH];
  int failed = 0;
  const int n =
      snprintf(folder, sizeof folder, "%s/pilewright_XXXXXX", place && *place ? place : "/tmp");
  PW_REQUIRE(n > 0 && n < PW_PATH - 16 && mkdtemp(folder), PW_ERR_FILE,
             "%s: no temporary folder %s for its mesh", path, folder);
  snprintf(file, sizeof file, "%.*s/mesh.msh", PW_PATH - 16, folder);
  gmsh.gmshOptionSetNumber("Mesh.Binary", 1.0, &failed);
  gmsh.gmshWrite(file, &failed);
  if (!failed) {
    gmsh.gmshClear(&failed);
    gmsh.gmshOpen(file, &failed);
  }
  unlink(file);
  rmdir(folder);
  PW_REQUIRE(!failed, PW_ERR_FILE, "%s: its mesh cannot be written to %s", path, file);
  return PW_OK;
}

static pw_status make(const pw_gmsh_recipe *recipe)
{
  int failed = 0;
  gmsh.gmshOpen(recipe->path, &failed);
  if (failed) {
    return refused(recipe->path, "run");
  }
  gmsh.gmshOptionSetNumber("Mesh.MeshSizeFactor", recipe->size_factor, &failed);
  gmsh.gmshModelMeshGenerate(3, &failed);
  if (failed) {
    return refused(recipe->path, "mesh");
  }
  gmsh.gmshModelMeshSetOrder(recipe->nodes == 10 ? 2 : 1, &failed);
  return failed ? refused(recipe->path, "make of second order") : write_and_reopen(recipe->path);
}

static pw_status open_file(const char *path, const pw_gmsh_recipe *recipe)
{
  int failed = 0;
  if (recipe) {
    return make(recipe);
  }
  gmsh.gmshOpen(path, &failed);
  PW_REQUIRE(!failed, PW_ERR_FILE, "%s: gmsh cannot read the file", path);
  return PW_OK;
}

pw_status pw_gmsh_open(const char *path, const pw_gmsh_recipe *recipe,
                       const pw_gmsh_library **library)
{
  PW_REQUIRE(access(path, R_OK) == 0, PW_ERR_FILE, "%s: cannot be opened", path);
  if (!recipe) {
    PW_TRY(check_file(path));
  }
  PW_TRY(load_library());
  *library = &gmsh;
  PW_TRY(initialize(recipe));
  pw_status s = open_file(path, recipe);
  if (s != PW_OK) {
    pw_gmsh_close(&gmsh);
  }
  return s;
}

void pw_gmsh_close(const pw_gmsh_library *library)
{
  int failed = 0;
  library->gmshFinalize(&failed);
  pw_threads_set_default(threads);
}

#else
typedef int pw_gmsh_library_is_left_out; /* a translation unit declares something */
#endif
