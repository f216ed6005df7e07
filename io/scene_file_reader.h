/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/scene_file_reader.h
 * @brief Inside of the scene reader: from a tree of nodes to a pw_scene (layer 4).
 */
#ifndef PW_IO_SCENE_FILE_READER_H
#define PW_IO_SCENE_FILE_READER_H

#include "engine/scene.h"
#include "engine/scene_keys.h"
#include "io/yaml_tree.h"

enum { PW_READER_ROWS = 64 /**< longest key table */ };

/** A part of the scene, the node it came from, and whether it was read without an error. */
typedef struct pw_reader_part {
  const pw_yaml_node *node;
  bool clean;
} pw_reader_part;

typedef struct pw_reader {
  pw_yaml_messages *m;
  const pw_yaml_node *root;
  pw_scene *scene;
  bool geometry_known; /**< plane strain or axisymmetric: the rules on places depend on it */
  pw_reader_part grid, time, method, output;
  pw_reader_part mesh, implicit; /**< of a solid scene */
  pw_reader_part material[PW_MAX_MATERIALS];
  pw_reader_part body[PW_MAX_BODIES];
  pw_reader_part effect[PW_MAX_EFFECTS];
} pw_reader;

/** What a mapping of keys is read into. */
typedef struct pw_reader_section {
  const char *title; /**< as named in messages */
  const pw_key *keys;
  void *base;
  int nextra;
  const char *const *extra; /**< [nextra] further keys it may hold, which the caller reads */
} pw_reader_section;

/** The file that is read, and changes made to it before it is checked. */
typedef struct pw_reader_source {
  const char *name;
  int nset;
  const char *const *set; /**< [nset] "key.path=value" */
} pw_reader_source;

/** What is read from a file: @ref read fills reader->scene, which is copied to @ref out when no
 *  error was found. */
typedef struct pw_reader_use {
  void (*read)(pw_reader *r, void *ctx);
  void *ctx;
  pw_scene *out;
  const char *what, *needs; /**< in messages: what the file is, sections it cannot do without */
} pw_reader_use;

/** @brief Read a file of scene sections; messages and return as pw_scene_read_file(). */
pw_status pw_reader_file(const pw_reader_source *from, const pw_reader_use *use, char **messages);

/**
 * @brief Read the value of @p key.
 * @return true; false after adding an error.
 */
bool pw_reader_value(pw_reader *r, const pw_key *key, const pw_yaml_node *node, pw_key_value *out);

/** @brief Read all keys of a section, with conditions and missing keys. @return true when no error
 *  was found. */
bool pw_reader_keys(pw_reader *r, const pw_reader_section *s, const pw_yaml_node *node);

/** @brief Report a child whose key its mapping has already. @return true when it is one. */
bool pw_reader_repeated(pw_reader *r, const pw_yaml_node *child);

/** @brief Place at which a whole section is reported: its key, or the start of a list entry. */
const pw_yaml_place *pw_reader_place(const pw_yaml_node *node);

/** @brief Put the parameters of named soils into the entries of `materials:` that have a key
 *  `soil:`; what an entry sets itself stands. A soil NAME is the file NAME.yaml, looked for in the
 *  folders soils and cases/soils of the file's folder and of those above it, of the working folder
 *  and beside the program. */
void pw_reader_soils(pw_reader *r);

/** @brief Read `materials:`; every name is registered even when its entry has errors. */
void pw_reader_materials(pw_reader *r);

/** @brief Read `bodies:`, likewise. */
void pw_reader_bodies(pw_reader *r);

/** @brief Read the sections of effects. */
void pw_reader_effects(pw_reader *r);

/** @brief Apply the rules across keys to the parts that are clean. */
void pw_reader_check(pw_reader *r);

#endif /* PW_IO_SCENE_FILE_READER_H */
