/* SPDX-License-Identifier: GPL-3.0-or-later */
/**
 * @file io/yaml_tree.h
 * @brief A YAML document as a tree of nodes that know their places (layer 4).
 *
 * The subset a scene needs: one document of mappings with plain keys, lists and scalars. Anchors,
 * aliases, tags and further documents are errors. libyaml does the parsing.
 */
#ifndef PW_IO_YAML_TREE_H
#define PW_IO_YAML_TREE_H

#include "io/yaml_messages.h"

typedef enum pw_yaml_kind { PW_YAML_SCALAR, PW_YAML_MAP, PW_YAML_LIST } pw_yaml_kind;

typedef struct pw_yaml_node pw_yaml_node;
struct pw_yaml_node {
  pw_yaml_kind kind;
  pw_yaml_place place;
  char *text;    /**< scalar: its value, zero-terminated */
  bool plain;    /**< scalar: written without quotes */
  bool has_zero; /**< scalar: holds a zero byte, so that text is cut */
  int count;     /**< children of a mapping or list */
  pw_yaml_node *first, *last;
  char *key; /**< its key when it stands in a mapping */
  pw_yaml_place key_place;
  const pw_yaml_node *earlier; /**< the node of its mapping with the same key, or NULL */
  pw_yaml_node *next;
};

/**
 * @brief Parse a document.
 * @param[in]     set  index of the `--set` entry the text belongs to, -1 for the file, or -2 - i
 *                     for included file i
 * @param[in,out] m    receives the error, one at most
 * @return the root, to be freed with pw_yaml_free; NULL after an error (m->n grew) or when memory
 *         ran out (m->out_of_memory). An empty document gives an empty plain scalar.
 */
pw_yaml_node *pw_yaml_parse(const char *text, size_t length, int set, pw_yaml_messages *m);

/** @brief Free a tree and null it; NULL is accepted. */
void pw_yaml_free(pw_yaml_node **root);

/** @brief A new node, unattached; NULL when memory ran out. */
pw_yaml_node *pw_yaml_node_new(pw_yaml_kind kind, pw_yaml_place place);

/** @brief Append @p child to a list, or to a mapping under its key; takes ownership. */
void pw_yaml_append(pw_yaml_node *parent, pw_yaml_node *child);

/** @brief First child of that key in a mapping, or NULL. */
pw_yaml_node *pw_yaml_find(const pw_yaml_node *map, const char *key);

/** @brief Child @p i of a mapping or list, or NULL. */
pw_yaml_node *pw_yaml_at(const pw_yaml_node *parent, int i);

/** @brief Whether the node is an unquoted nothing: "", ~ or null. */
bool pw_yaml_is_null(const pw_yaml_node *node);

/** @brief "a mapping", "a list", "nothing" or the scalar in quotes, for messages.
 *  @param[out] out [PW_YAML_SHOWN + 8] */
void pw_yaml_describe(const pw_yaml_node *node, char *out);

/**
 * @brief Apply one `--set key.path=value` to the tree: mappings and lists on the way are made
 *        where they are missing, list entries are given by index, one past the end appends.
 * @param[in] set   index of the entry in m->set
 */
void pw_yaml_set(pw_yaml_node *root, int set, pw_yaml_messages *m);

#endif /* PW_IO_YAML_TREE_H */
