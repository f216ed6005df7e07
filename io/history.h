/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/history.h
 * @brief Time series of a run: history.csv (layer 4).
 *
 * The first line holds the names with units, the first two columns are time_s and step. A row is
 * appended with one write, so that a killed run leaves whole rows; a row that cannot be written
 * in full is taken back. Numbers have nine significant digits, time_s twelve; NaN is `nan`.
 */
#ifndef PW_IO_HISTORY_H
#define PW_IO_HISTORY_H

#include "engine/core/record.h"
#include "engine/core/status.h"

typedef struct pw_history pw_history;

/**
 * @brief Start a new file, replacing an old one; the names of @p header become the first line.
 *        @p header itself is not written as a row.
 * @return PW_OK; PW_ERR_FILE; PW_ERR_MEMORY; PW_ERR_ARGUMENT when the first two names are not
 *         time_s and step, or an item is a list.
 */
pw_status pw_history_open(const char *path, const pw_record *header, pw_history **out);

/**
 * @brief Go on with the file of an earlier run: rows after @p step are dropped. A missing file is
 *        started anew.
 * @return as pw_history_open; PW_ERR_FILE when the file's names are not those of @p header.
 */
pw_status pw_history_resume(const char *path, const pw_record *header, pw_off step,
                            pw_history **out);

/**
 * @brief Append one row; it is in the file when this returns.
 * @return PW_OK; PW_ERR_FILE with path and reason; PW_ERR_ARGUMENT when the names changed.
 */
pw_status pw_history_append(pw_history *h, const pw_record *row);

/** @brief Wait until all rows are on the disk: call before a checkpoint is written.
 *  @return PW_OK; PW_ERR_FILE. */
pw_status pw_history_sync(pw_history *h);

/** @brief Close, free and null; NULL is accepted. @return PW_OK; PW_ERR_FILE. */
pw_status pw_history_close(pw_history **h);

#endif /* PW_IO_HISTORY_H */
