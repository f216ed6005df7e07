/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/yaml_messages.h
 * @brief All errors found in a scene file, with their places and source lines (layer 4).
 */
#ifndef PW_IO_YAML_MESSAGES_H
#define PW_IO_YAML_MESSAGES_H

#include <stdbool.h>
#include <stddef.h>

/** Where something was written: in the file, in one of the `--set` entries, or in a file that the
 *  file includes. */
typedef struct pw_yaml_place {
  int set;          /**< index of the `--set` entry, -1 for the file, -2 - i for included file i */
  int line, column; /**< from 1, counted in characters; of files only */
} pw_yaml_place;

/** A file included by another. */
typedef struct pw_yaml_file {
  char *name, *text; /**< owned */
  size_t length;
} pw_yaml_file;

enum { PW_YAML_FILES = 16 };

typedef struct pw_yaml_message {
  pw_yaml_place place;
  char *what;
} pw_yaml_message;

typedef struct pw_yaml_messages {
  const char *name; /**< of the file, as shown; borrowed */
  const char *text; /**< [length] the source; borrowed */
  size_t length;
  const char *const *set; /**< the `--set` entries; borrowed */
  int nfile;
  pw_yaml_file file[PW_YAML_FILES]; /**< included files */
  int n;                            /**< errors found; those past a limit are counted, not kept */
  int kept;
  bool out_of_memory;
  pw_yaml_message *item;
} pw_yaml_messages;

/** @brief Add an error. */
void pw_yaml_error(pw_yaml_messages *m, const pw_yaml_place *place, const char *fmt, ...)
    __attribute__((format(printf, 3, 4)));

/** @brief Place in the file of the byte @p offset of the source. */
pw_yaml_place pw_yaml_place_at(const pw_yaml_messages *m, size_t offset);

/**
 * @brief All errors as one text: those of the file by line and column, then those of `--set`.
 *        Each is `file:line:column: error: ...` with the source line and a caret under it, or
 *        `--set key=value: error: ...`.
 * @return text to be freed by the caller; NULL when memory ran out.
 */
char *pw_yaml_messages_text(pw_yaml_messages *m);

void pw_yaml_messages_free(pw_yaml_messages *m);

/** @brief @p text shortened and without control characters, as shown in a message.
 *  @param[out] out [PW_YAML_SHOWN] */
void pw_yaml_shown(const char *text, char *out);

enum { PW_YAML_SHOWN = 64 };

/** The candidate closest to a mistyped word, found by offering the known words one by one. */
typedef struct pw_yaml_nearest {
  const char *word; /**< what was written; borrowed */
  const char *best; /**< NULL when no candidate is close; borrowed */
  int distance;
} pw_yaml_nearest;

/** @brief Compare one known word: fewest edits win, the first on a tie; a word that only lacks its
 *  unit ("cell" for "cell_m") counts as one edit, another ending of a long word as few. */
void pw_yaml_nearest_offer(pw_yaml_nearest *nearest, const char *candidate);

/** @brief Text "; did you mean 'best'?" or "". @param[out] out [PW_YAML_HINT] */
void pw_yaml_nearest_hint(const pw_yaml_nearest *nearest, char *out);

enum { PW_YAML_HINT = 96 };

#endif /* PW_IO_YAML_MESSAGES_H */
