/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/scene_file.h
 * @brief Scene files: YAML to pw_scene, with every error at its place (layer 4).
 *
 * Driven by the key tables of the scene, its materials and its effects. All errors are found in
 * one go: syntax, unknown, missing and repeated keys, wrong types, values out of range or not
 * finite, unknown names, keys without what they need, and the rules across keys.
 */
#ifndef PW_IO_SCENE_FILE_H
#define PW_IO_SCENE_FILE_H

#include "engine/scene.h"

/**
 * @brief Read a scene file.
 * @param[in]  set      [nset] changes "key.path=value" made before checking; entries of lists by
 *                      index: "boundary.0.side=left"; a path may make keys and sections that the
 *                      file lacks
 * @param[out] out      the scene; untouched on failure
 * @param[out] messages all errors, to be freed by the caller; NULL on success or when memory ran
 *                      out. Each is `file:line:column: error: ...` with the source line and a
 *                      caret under the column, or `--set key.path=value: error: ...`
 * @return PW_OK; PW_ERR_SCENE; PW_ERR_FILE when the file cannot be read; PW_ERR_MEMORY.
 */
pw_status pw_scene_read_file(const char *path, int nset, const char *const *set, pw_scene *out,
                             char **messages);

/** @brief Read a scene from text in memory; @p name stands for the file's name in messages.
 *  @return as pw_scene_read_file, never PW_ERR_FILE. */
pw_status pw_scene_read_text(const char *text, size_t length, const char *name, int nset,
                             const char *const *set, pw_scene *out, char **messages);

/**
 * @brief Show a message that begins with the path of a key, "boundary.2.group: the mesh has no ...",
 *        at the key's place in a scene file that was read without errors.
 * @param[in] nset, set as given when it was read
 * @return text as of pw_scene_read_file(), to be freed by the caller; NULL when @p message begins
 *         with no key of the file, or when memory ran out.
 */
char *pw_scene_locate(const char *path, int nset, const char *const *set, const char *message);

#endif /* PW_IO_SCENE_FILE_H */
