/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/atomic_file.h
 * @brief Files that are either the old one or the whole new one, never a part (layer 4).
 *
 * A file is written under a temporary name in the same folder ("name.part"), synchronised to the
 * disk and renamed over the old one. An interrupted or failed write leaves the old file whole.
 */
#ifndef PW_IO_ATOMIC_FILE_H
#define PW_IO_ATOMIC_FILE_H

#include "engine/core/status.h"

enum { PW_PATH = 1024 /**< bytes of a path, the closing zero included */ };

/**
 * @brief Join @p folder and @p name with a slash into @p out [PW_PATH].
 * @return PW_OK; PW_ERR_FILE when the path is too long.
 */
pw_status pw_path_join(const char *folder, const char *name, char *out);

/**
 * @brief Make the folder @p path and the ones above it; existing ones are fine.
 * @return PW_OK; PW_ERR_FILE with path and reason.
 */
pw_status pw_make_folder(const char *path);

/**
 * @brief Replace the file @p path by @p size bytes.
 * @return PW_OK; PW_ERR_FILE with path and the system's reason: the old file is untouched.
 */
pw_status pw_atomic_write(const char *path, const void *bytes, size_t size);

/**
 * @brief Name under which another program may write before pw_atomic_commit.
 * @param[out] temp [PW_PATH]
 * @return PW_OK; PW_ERR_FILE when the path is too long.
 */
pw_status pw_atomic_temp(const char *path, char *temp);

/**
 * @brief Synchronise the file @p temp and rename it to @p path.
 * @return PW_OK; PW_ERR_FILE: @p temp is removed and the old file is untouched.
 */
pw_status pw_atomic_commit(const char *temp, const char *path);

#endif /* PW_IO_ATOMIC_FILE_H */
