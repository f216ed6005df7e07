/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Fuzz target of the scene reader for libFuzzer; not part of the build. With the library built by
 * clang with PW_SANITIZE=address,undefined in BUILD:
 *
 *   clang -g -O1 -fsanitize=fuzzer,address,undefined -I. tests/fuzz_scene.c BUILD/libpilewright.a \
 *     -fopenmp -lyaml -ljansson -lmetis -lhdf5_serial -lm -o fuzz_scene
 *   ./fuzz_scene -max_len=8192 CORPUS tests/scenes tests/scenes/bad
 *
 * The first byte says how many lines at the start of the input are --set entries. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "io/scene_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

enum { SETS = 4, ENTRY = 256 };

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
  static char entry[SETS][ENTRY];
  const char *set[SETS];
  static pw_scene scene;
  const char *text = (const char *)bytes;
  int n = 0;
  if (size > 0 && bytes[0] <= SETS) {
    int wanted = bytes[0];
    text++;
    size--;
    for (; n < wanted; n++) {
      const char *end = memchr(text, '\n', size);
      if (!end || end - text >= ENTRY) {
        break;
      }
      memcpy(entry[n], text, (size_t)(end - text));
      entry[n][end - text] = '\0';
      set[n] = entry[n];
      size -= (size_t)(end - text) + 1;
      text = end + 1;
    }
  }
  char *messages = NULL;
  pw_status status = pw_scene_read_text(text, size, "fuzz", n, set, &scene, &messages);
  if (status == PW_OK ? messages != NULL || pw_scene_check(&scene) != PW_OK
                      : status != PW_ERR_SCENE || !messages || !strstr(messages, ": error: ")) {
    abort();
  }
  free(messages);
  return 0;
}
