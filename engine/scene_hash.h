/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/scene_hash.h
 * @brief One number that tells scenes with other results apart, for checkpoints (layer 3).
 */
#ifndef PW_ENGINE_SCENE_HASH_H
#define PW_ENGINE_SCENE_HASH_H

#include "engine/scene.h"

/** @brief Hash of everything that results depend on, so not of outputs, title and file, nor of the
 *  end of an explicit run. Meshes from files are not looked at. */
uint64_t pw_scene_hash(const pw_scene *scene);

/** @brief Go on with a hash over @p size bytes. */
void pw_hash_bytes(uint64_t *hash, const void *data, size_t size);

#endif /* PW_ENGINE_SCENE_HASH_H */
