/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/element_file.h
 * @brief Element tests: a YAML file with materials as in a scene and a list of stages (layer 4).
 */
#ifndef PW_IO_ELEMENT_FILE_H
#define PW_IO_ELEMENT_FILE_H

#include "engine/element_test.h"

/** Key tables of the sections `element:` and `stages:`, and of the top level. */
extern const pw_key pw_element_keys[];
extern const pw_key pw_element_keys_top[];
extern const pw_key pw_element_keys_stage[];

/**
 * @brief Read a test.
 * @param[in]  set      [nset] changes "key.path=value" made before checking
 * @param[out] messages as of pw_scene_read_file()
 * @return as pw_scene_read_file().
 */
pw_status pw_element_read(const char *path, int nset, const char *const *set, pw_element_test *out,
                          char **messages);

#endif /* PW_IO_ELEMENT_FILE_H */
