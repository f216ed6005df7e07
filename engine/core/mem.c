/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/core/mem.h"

#include <stdlib.h>
#include <string.h>

/* A header of one alignment unit in front of each block remembers its size. */
typedef struct {
  pw_off bytes;
  const char *label;
} mem_header;

static pw_off mem_count, mem_bytes, mem_fail;

static bool injected_failure(void)
{
  return mem_fail > 0 && --mem_fail == 0;
}

pw_status pw_mem_alloc(const char *label, pw_off count, size_t size, void *out)
{
  void *block = NULL;
  memcpy(out, &block, sizeof block);
  PW_REQUIRE(count >= 0 && (size == 0 || count <= INT64_MAX / 2 / (pw_off)size), PW_ERR_ARGUMENT,
             "%s: %lld elements of %zu bytes is not a size", label, (long long)count, size);
  if (count == 0) {
    return PW_OK;
  }
  pw_off bytes = (count * (pw_off)size + PW_ALIGN - 1) / PW_ALIGN * PW_ALIGN;
  if (!injected_failure()) {
    block = aligned_alloc(PW_ALIGN, (size_t)bytes + PW_ALIGN);
  }
  PW_REQUIRE(block, PW_ERR_MEMORY, "cannot allocate %lld bytes for %s", (long long)bytes, label);
  memset(block, 0, (size_t)bytes + PW_ALIGN);
  mem_header header = {bytes, label};
  memcpy(block, &header, sizeof header);
  mem_count++;
  mem_bytes += bytes;
  block = (char *)block + PW_ALIGN;
  memcpy(out, &block, sizeof block);
  return PW_OK;
}

void pw_mem_free(void *ptr)
{
  void *block = NULL;
  memcpy(&block, ptr, sizeof block);
  if (!block) {
    return;
  }
  mem_header header;
  block = (char *)block - PW_ALIGN;
  memcpy(&header, block, sizeof header);
  mem_bytes -= header.bytes;
  free(block);
  block = NULL;
  memcpy(ptr, &block, sizeof block);
}

pw_off pw_mem_count(void)
{
  return mem_count;
}

pw_off pw_mem_bytes(void)
{
  return mem_bytes;
}

void pw_mem_fail_after(pw_off nth)
{
  mem_fail = nth;
}
