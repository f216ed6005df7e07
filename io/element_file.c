/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/element_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/scene_file_reader.h"

/** What `element:` holds before it is checked. */
typedef struct element_section {
  int material; /* index into the scene's materials */
  pw_reals stress_pa;
  pw_real height_y_m;
  bool pictures;
} element_section;

#define AT_TEST(member)    offsetof(pw_element_test, member)
#define AT_ELEMENT(member) offsetof(element_section, member)
#define AT_STAGE(member)   offsetof(pw_element_stage, member)
#define STRESS_PA          1e15

const pw_key pw_element_keys_top[] = {
    {"title", PW_KEY_TEXT, AT_TEST(title), 0, 0, "", NULL, NULL, "name of the test in pictures"},
    {NULL, PW_KEY_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

const pw_key pw_element_keys[] = {
    {"material", PW_KEY_MATERIAL, AT_ELEMENT(material), 0, 0, NULL, NULL, NULL,
     "one of the names under materials"},
    {"initial_stress_pa", PW_KEY_REALS, AT_ELEMENT(stress_pa), -STRESS_PA, STRESS_PA, "[]", NULL,
     NULL, "[mean], [xx, yy, zz] or [xx, yy, zz, xy, yz, zx], tension positive; none: zero"},
    {"height_y_m", PW_KEY_REAL, AT_ELEMENT(height_y_m), -1e6, 1e6, "0", NULL, NULL,
     "height of the element, for materials that change with depth"},
    {"pictures", PW_KEY_BOOL, AT_ELEMENT(pictures), 0, 0, "true", NULL, NULL,
     "draw curves as PNG and SVG files"},
    {NULL, PW_KEY_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

#define LOADED "kind=isotropic|oedometric|triaxial|biaxial|simple_shear"
const pw_key pw_element_keys_stage[] = {
    {"kind", PW_KEY_CHOICE, AT_STAGE(kind), 0, 0, NULL,
     "isotropic|oedometric|triaxial|biaxial|simple_shear|mixed|strain_path", NULL,
     "what is held and what is moved; the axis is y"},
    {"drained", PW_KEY_BOOL, AT_STAGE(drained), 0, 0, "true", NULL,
     "kind=triaxial|biaxial|simple_shear", "false: the volume is kept"},
    {"to_strain", PW_KEY_REALS, AT_STAGE(to_strain), -20, 20, "[]", NULL, LOADED,
     "turning points of the axial strain (isotropic: of each normal strain; simple_shear: of the "
     "engineering shear strain) since the start of the stage, tension positive"},
    {"to_stress_pa", PW_KEY_REALS, AT_STAGE(to_stress_pa), -STRESS_PA, STRESS_PA, "[]", NULL,
     LOADED,
     "turning points of sigma_yy (isotropic: of each normal stress; simple_shear: of sigma_xy); "
     "this or to_strain"},
    {"mixed_stress", PW_KEY_REALS, AT_STAGE(mixed_stress), 0, 1, NULL, NULL, "kind=mixed",
     "six numbers for xx, yy, zz, xy, yz, zx: 1 where the stress is prescribed, 0 the strain"},
    {"mixed_target", PW_KEY_REALS, AT_STAGE(mixed_target), -STRESS_PA, STRESS_PA, NULL, NULL,
     "kind=mixed",
     "six ends: strain (tensor shears) since the start of the stage, or stress in Pa; with more "
     "than one cycle the stage goes there and back"},
    {"file", PW_KEY_TEXT, AT_STAGE(file), 0, 0, NULL, NULL, "kind=strain_path",
     "CSV beside the test: columns among eps_xx, eps_yy, eps_zz, eps_xy, eps_yz, eps_zx (tensor "
     "shears) and spin_xy, spin_yz, spin_zx (rad), each since the start of the stage"},
    {"cycles", PW_KEY_INT, AT_STAGE(cycles), 1, 100000, "1", NULL, LOADED "|mixed",
     "times the turning points are run through"},
    {"steps", PW_KEY_INT, AT_STAGE(steps), 1, 1000000, "100", NULL, LOADED "|mixed",
     "steps between two turning points"},
    {NULL, PW_KEY_REAL, 0, 0, 0, NULL, NULL, NULL, NULL},
};

static const pw_yaml_place start_of_file = {-1, 1, 1};

static bool complain(pw_reader *r, const pw_yaml_node *section, const char *key, const char *rule)
{
  const pw_yaml_node *child = section ? pw_yaml_find(section, key) : NULL;
  const pw_yaml_place *place = child     ? &child->place
                               : section ? pw_reader_place(section)
                                         : &start_of_file;
  pw_yaml_error(r->m, place, "%s", rule);
  return false;
}

static bool check_stage(pw_reader *r, const pw_yaml_node *node, const pw_element_stage *s)
{
  if (s->kind < PW_STAGE_MIXED && (s->to_strain.n > 0) == (s->to_stress_pa.n > 0)) {
    return complain(r, node, s->to_strain.n > 0 ? "to_stress_pa" : "kind",
                    "a stage needs turning points: one of to_strain and to_stress_pa");
  }
  if (s->kind == PW_STAGE_MIXED) {
    if (s->mixed_stress.n != 6 || s->mixed_target.n != 6) {
      return complain(r, node, s->mixed_stress.n != 6 ? "mixed_stress" : "mixed_target",
                      "mixed_stress and mixed_target hold six numbers: xx, yy, zz, xy, yz, zx");
    }
    for (int c = 0; c < 6; c++) {
      if (s->mixed_stress.v[c] != 0.0 && s->mixed_stress.v[c] != 1.0) {
        return complain(r, node, "mixed_stress", "mixed_stress holds zeros and ones");
      }
    }
  }
  if (s->kind == PW_STAGE_PATH && !*s->file) {
    return complain(r, node, "file", "'file' must name a CSV file");
  }
  return true;
}

static void read_stages(pw_reader *r, pw_element_test *t)
{
  const pw_yaml_node *list = pw_yaml_find(r->root, "stages");
  if (!list || list->kind != PW_YAML_LIST || list->count == 0) {
    complain(r, list, "", list ? "stages must be a list of mappings" : "missing section 'stages'");
    return;
  }
  for (const pw_yaml_node *entry = list->first; entry; entry = entry->next) {
    if (t->nstage == PW_MAX_STAGES) {
      complain(r, entry, "", "too many stages: 32 at most");
      return;
    }
    char title[PW_NAME];
    pw_element_stage *s = &t->stage[t->nstage];
    snprintf(title, sizeof title, "stages.%d", t->nstage++);
    pw_reader_section section = {title, pw_element_keys_stage, s, 0, NULL};
    pw_scene_defaults(pw_element_keys_stage, s);
    if (pw_reader_keys(r, &section, entry)) {
      check_stage(r, entry, s);
    }
  }
}

static void take_element(pw_reader *r, const pw_yaml_node *node, const element_section *e,
                         pw_element_test *t)
{
  const pw_reals *s = &e->stress_pa;
  pw_real size = 0.0;
  t->material = r->scene->material[e->material];
  t->height_y_m = e->height_y_m;
  t->pictures = e->pictures;
  if (s->n != 0 && s->n != 1 && s->n != 3 && s->n != 6) {
    complain(r, node, "initial_stress_pa", "initial_stress_pa holds 1, 3 or 6 numbers");
    return;
  }
  for (int c = 0; c < 6 && s->n > 0; c++) {
    t->stress_pa[c] = s->n == 1 ? (c < 3 ? s->v[0] : 0.0) : c < s->n ? s->v[c] : 0.0;
    size += t->stress_pa[c] < 0.0 ? -t->stress_pa[c] : t->stress_pa[c];
  }
  if (size > 0.0 && t->material.model && !t->material.model->takes_initial_stress) {
    complain(r, node, "initial_stress_pa", "this material cannot start from a given stress");
  }
}

static void read_test(pw_reader *r, void *ctx)
{
  static const char *const words[] = {"materials", "element", "stages"};
  pw_element_test *t = ctx;
  element_section e = {.material = 0};
  pw_reader_section top = {"the test", pw_element_keys_top, t, 3, words};
  pw_reader_section element = {"element", pw_element_keys, &e, 0, NULL};
  const pw_yaml_node *node = pw_yaml_find(r->root, "element");
  snprintf(t->file, sizeof t->file, "%s", r->m->name);
  pw_scene_defaults(pw_element_keys_top, t);
  pw_scene_defaults(pw_element_keys, &e);
  pw_reader_keys(r, &top, r->root);
  pw_reader_soils(r);
  pw_reader_materials(r);
  pw_reader_check(r); /* the materials' own rules */
  if (!node) {
    complain(r, NULL, "", "missing section 'element'");
  } else if (pw_reader_keys(r, &element, node)) {
    take_element(r, node, &e, t);
  }
  read_stages(r, t);
}

pw_status pw_element_read(const char *path, int nset, const char *const *set, pw_element_test *out,
                          char **messages)
{
  pw_scene *scene = calloc(1, sizeof *scene);
  pw_element_test *test = calloc(1, sizeof *test);
  const pw_reader_source from = {path, nset, set};
  const pw_reader_use use = {read_test, test, scene, "a test", "materials, element and stages"};
  pw_status status = PW_ERR_MEMORY;
  *messages = NULL;
  if (scene && test) {
    status = pw_reader_file(&from, &use, messages);
  }
  if (status == PW_OK) {
    *out = *test;
  }
  free(test);
  free(scene);
  return status;
}
