/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/solver_store.h"

#include <SuiteSparse_config.h>
#include <stdbool.h>
#include <string.h>

enum { LARGE = 1 << 20, BLOCKS = 64 }; /* bytes of a block worth keeping; how many are watched */

typedef struct {
  void *at;    /* NULL: no block */
  size_t size; /* bytes */
  bool used;   /* by SuiteSparse; else kept */
} block;

static block blocks[BLOCKS];
static int users;
static void *(*system_malloc)(size_t);
static void *(*system_calloc)(size_t, size_t);
static void *(*system_realloc)(void *, size_t);
static void (*system_free)(void *);

static block *find(const void *at)
{
  for (int i = 0; at && i < BLOCKS; i++) {
    if (blocks[i].at == at) {
      return &blocks[i];
    }
  }
  return NULL;
}

/* The smallest kept block of `size` bytes or more, if not far too large. */
static block *find_kept(size_t size)
{
  block *best = NULL;
  for (int i = 0; i < BLOCKS; i++) {
    block *b = &blocks[i];
    if (b->at && !b->used && b->size >= size && b->size / 2 <= size &&
        (!best || b->size < best->size)) {
      best = b;
    }
  }
  return best;
}

static void return_kept(void)
{
  for (int i = 0; i < BLOCKS; i++) {
    if (blocks[i].at && !blocks[i].used) {
      system_free(blocks[i].at);
      blocks[i] = (block){.at = NULL};
    }
  }
}

/* UMFPACK starts with what it hopes will do and asks for a fifth more once or twice: there is room
 * to grow in place. Pages that nobody writes to cost nothing. */
static void *take(size_t size)
{
  block *b = size >= LARGE ? find_kept(size) : NULL;
  if (b) {
    b->used = true;
    return b->at;
  }
  const size_t room = size >= LARGE ? size + size / 8 * 3 : size;
  void *at = system_malloc(room);
  if (!at) { /* what is kept may be what is missing */
    return_kept();
    at = system_malloc(room);
  }
  for (int i = 0; at && size >= LARGE && i < BLOCKS; i++) {
    if (!blocks[i].at) {
      blocks[i] = (block){.at = at, .size = room, .used = true};
      break;
    }
  }
  return at;
}

static void *take_cleared(size_t count, size_t size)
{
  if (size != 0 && count > (size_t)-1 / size) {
    return NULL;
  }
  if (count * size < LARGE) {
    return system_calloc(count, size);
  }
  void *at = take(count * size);
  return at ? memset(at, 0, count * size) : NULL;
}

static void give(void *at)
{
  block *b = find(at);
  if (b) {
    b->used = false;
  } else {
    system_free(at);
  }
}

static void *change(void *at, size_t size)
{
  block *b = find(at);
  if (!b) {
    return system_realloc(at, size);
  }
  if (size <= b->size) {
    return at;
  }
  void *to = take(size);
  if (to) {
    memcpy(to, at, b->size);
    b->used = false;
  }
  return to;
}

void pw_solver_store_open(void)
{
  if (users++ > 0) {
    return;
  }
  system_malloc = SuiteSparse_config.malloc_func;
  system_calloc = SuiteSparse_config.calloc_func;
  system_realloc = SuiteSparse_config.realloc_func;
  system_free = SuiteSparse_config.free_func;
  SuiteSparse_config.malloc_func = take;
  SuiteSparse_config.calloc_func = take_cleared;
  SuiteSparse_config.realloc_func = change;
  SuiteSparse_config.free_func = give;
}

void pw_solver_store_close(void)
{
  if (--users > 0) {
    return;
  }
  return_kept();
  SuiteSparse_config.malloc_func = system_malloc;
  SuiteSparse_config.calloc_func = system_calloc;
  SuiteSparse_config.realloc_func = system_realloc;
  SuiteSparse_config.free_func = system_free;
}
