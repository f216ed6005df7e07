/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/main.h"

#include <getopt.h>
#include <stdlib.h>
#include <string.h>

#include "io/element_run.h"

enum { OPTION_OUT = 1, OPTION_SET, OPTION_KEYS };

static const struct option options[] = {{"out", required_argument, NULL, OPTION_OUT},
                                        {"set", required_argument, NULL, OPTION_SET},
                                        {"keys", no_argument, NULL, OPTION_KEYS},
                                        {"help", no_argument, NULL, 'h'},
                                        {NULL, 0, NULL, 0}};

static pw_exit usage(const char *what, const char *word)
{
  fprintf(stderr, "error: %s%s\ntry: pilewright element --help\n", what, word ? word : "");
  return PW_EXIT_USAGE;
}

static pw_exit element(int argc, char **argv, const char **set)
{
  pw_element_options o = {.set = set};
  int option;
  opterr = 0;
  while ((option = getopt_long(argc, argv, ":h", options, NULL)) != -1) {
    switch (option) {
    case OPTION_OUT:
      o.out = optarg;
      break;
    case OPTION_SET:
      set[o.nset++] = optarg;
      break;
    case OPTION_KEYS:
      pw_element_keys_print(stdout);
      return PW_EXIT_FINISHED;
    case 'h':
      fputs(pw_main_help("element"), stdout);
      return PW_EXIT_FINISHED;
    case ':':
      return usage("a value is missing after ", argv[optind - 1]);
    default:
      return usage("unknown option ", pw_main_unknown(argv));
    }
  }
  if (optind + 1 != argc) {
    return usage(optind < argc ? "one test file at a time, not also " : "no test file",
                 optind < argc ? argv[optind + 1] : NULL);
  }
  o.test_file = argv[optind];
  return pw_element_main(&o, stdout, stderr);
}

int pw_main_element(int argc, char **argv)
{
  const char **set = calloc((size_t)argc + 1, sizeof *set);
  pw_exit code = set ? element(argc, argv, set) : PW_EXIT_FAILED;
  free(set);
  return code;
}
