/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file engine/core/archive.h
 * @brief Visitor through which state is written to and read from a checkpoint (layer 0).
 *
 * The engine walks its state once, in one function per owner, calling these for every array; the
 * same walk saves and loads. Names are paths such as "points/stress". io/restart.c implements the
 * visitor on HDF5; tests implement it on memory.
 */
#ifndef PW_CORE_ARCHIVE_H
#define PW_CORE_ARCHIVE_H

#include "engine/core/status.h"

typedef struct pw_archive pw_archive;
struct pw_archive {
  bool loading; /**< true: arrays are filled from the file; false: they are written to it */
  /** @p count values; when loading, the stored count must equal @p count. */
  pw_status (*real)(pw_archive *ar, const char *name, pw_real *value, pw_off count);
  pw_status (*index)(pw_archive *ar, const char *name, pw_idx *value, pw_off count);
  pw_status (*offset)(pw_archive *ar, const char *name, pw_off *value, pw_off count);
};

#endif /* PW_CORE_ARCHIVE_H */
