/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/main.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "engine/pilewright.h"

enum { MAX_THREADS = 1024 };

static pw_exit usage(const char *command, const char *what, const char *word)
{
  fprintf(stderr, "error: %s%s\ntry: pilewright%s%s --help\n", what, word ? word : "",
          command ? " " : "", command ? command : "");
  return PW_EXIT_USAGE;
}

const char *pw_main_unknown(char *const *argv)
{
  static char letter[] = "-?";
  if (optopt < ' ' || optopt == 'h') { /* a long option; -h is known */
    return argv[optind - 1];
  }
  letter[1] = (char)optopt;
  return letter;
}

static bool read_threads(const char *text, int *threads)
{
  char *end = NULL;
  long n = strtol(text, &end, 10);
  *threads = n > 0 && n <= MAX_THREADS ? (int)n : 0;
  return end != text && *end == '\0' && *threads > 0;
}

static void print_help(const char *command)
{
  fputs(pw_main_help(command), stdout);
}

enum { OPTION_OUT = 1, OPTION_THREADS, OPTION_SET, OPTION_RESUME, OPTION_FORCE, OPTION_QUIET };

static const struct option all_options[] = {
    {"out", required_argument, NULL, OPTION_OUT},
    {"threads", required_argument, NULL, OPTION_THREADS},
    {"set", required_argument, NULL, OPTION_SET},
    {"resume", no_argument, NULL, OPTION_RESUME},
    {"force", no_argument, NULL, OPTION_FORCE},
    {"quiet", no_argument, NULL, OPTION_QUIET},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

/* Options of `run` and `check`. @return PW_EXIT_FINISHED, *help set when help is asked for. */
static pw_exit read_options(int argc, char **argv, pw_run_options *o, const char **set, bool *help)
{
  const char *command = argv[0];
  bool runs = strcmp(command, "run") == 0;
  int option, place = 0;

  opterr = 0;
  o->set = set;
  while ((option = getopt_long(argc, argv, ":h", all_options, &place)) != -1) {
    if (!runs && option != OPTION_SET && option != OPTION_THREADS && option != 'h' && option < 32) {
      return usage(command, "not an option of this command: --", all_options[place].name);
    }
    switch (option) {
    case OPTION_OUT:
      o->out = optarg;
      break;
    case OPTION_THREADS:
      if (!read_threads(optarg, &o->threads)) {
        return usage(command, "--threads wants a whole number from 1 to 1024, not ", optarg);
      }
      break;
    case OPTION_SET:
      set[o->nset++] = optarg;
      break;
    case OPTION_RESUME:
      o->resume = true;
      break;
    case OPTION_FORCE:
      o->force = true;
      break;
    case OPTION_QUIET:
      o->quiet = true;
      break;
    case 'h':
      *help = true;
      return PW_EXIT_FINISHED;
    case ':':
      return usage(command, "a value is missing after ", argv[optind - 1]);
    default:
      return usage(command, "unknown option ", pw_main_unknown(argv));
    }
  }
  if (optind + 1 != argc) {
    return usage(command, optind < argc ? "one scene file at a time, not also " : "no scene file",
                 optind < argc ? argv[optind + 1] : NULL);
  }
  o->scene_file = argv[optind];
  return o->resume && o->force ? usage(command, "--resume and --force exclude each other", NULL)
                               : PW_EXIT_FINISHED;
}

/* Messages of the reader, or the last error, at its place in the scene where it names a key. */
static void print_errors(const pw_run_options *o, pw_status status, char *messages)
{
  char *located = messages && *messages
                      ? NULL
                      : pw_scene_locate(o->scene_file, o->nset, o->set, pw_error_text());
  if (messages && *messages) {
    fputs(messages, stderr);
  } else if (located) {
    fputs(located, stderr);
  } else {
    fprintf(stderr, "error: %s\n", *pw_error_text() ? pw_error_text() : pw_status_text(status));
  }
  free(located);
}

static pw_exit check(const pw_run_options *o)
{
  char *messages = NULL;
  pw_job job = {NULL, NULL};
  pw_scene *scene = malloc(sizeof *scene);
  pw_status status = scene ? PW_OK : PW_ERR_MEMORY;

  if (status == PW_OK) {
    status = pw_scene_read_file(o->scene_file, o->nset, o->set, scene, &messages);
  }
  if (status == PW_OK) {
    job.kind = pw_job_kind_of(scene);
    const char *geometry = pw_solid_mesh_geometry(scene);
    if (geometry) {
      fprintf(stderr, "meshing %s ...\n", geometry);
    }
    status = job.kind->create(scene, o->threads, &job.sim);
  }
  if (status == PW_OK) {
    status = job.kind->check(job.sim, stdout);
    fflush(stdout);
  }
  if (status == PW_OK) {
    printf("%s can be run\n", o->scene_file);
  } else {
    print_errors(o, status, messages);
  }
  if (job.kind) {
    job.kind->destroy(&job.sim);
  }
  free(messages);
  free(scene);
  return status == PW_OK ? PW_EXIT_FINISHED : PW_EXIT_SCENE;
}

/* `run` and `check`: argv[0] is the command. */
static pw_exit with_scene(int argc, char **argv, char **whole_argv)
{
  pw_run_options o = {0};
  bool help = false;
  const char **set = calloc((size_t)argc + 1, sizeof *set);
  pw_exit code = set ? read_options(argc, argv, &o, set, &help) : PW_EXIT_FAILED;

  if (code == PW_EXIT_FINISHED && help) {
    print_help(argv[0]);
  } else if (code == PW_EXIT_FINISHED) {
    o.bound = pw_main_bind_threads(whole_argv, o.threads);
    code = strcmp(argv[0], "run") == 0 ? pw_run(&o, stdout, stderr) : check(&o);
  }
  free(set);
  return code;
}

/* `keys` and `list` take no arguments. */
static pw_exit print_table(int argc, char **argv, void (*print)(FILE *))
{
  if (argc > 1 && (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0)) {
    print_help(argv[0]);
    return PW_EXIT_FINISHED;
  }
  if (argc > 1) {
    return usage(argv[0], "this command takes no arguments, not ", argv[1]);
  }
  print(stdout);
  return PW_EXIT_FINISHED;
}

static pw_exit dispatch(int argc, char **argv)
{
  const char *command = argc > 1 ? argv[1] : "";
  char **rest = argv + 1;

  if (strcmp(command, "run") == 0 || strcmp(command, "check") == 0) {
    return with_scene(argc - 1, rest, argv);
  }
  if (strcmp(command, "element") == 0) {
    return (pw_exit)pw_main_element(argc - 1, rest);
  }
  if (strcmp(command, "keys") == 0) {
    return print_table(argc - 1, rest, pw_keys_print);
  }
  if (strcmp(command, "list") == 0) {
    return print_table(argc - 1, rest, pw_list_print);
  }
  if (strcmp(command, "--version") == 0) {
    printf("pilewright %s (%s)\n", pw_version(), pw_git_revision());
    return PW_EXIT_FINISHED;
  }
  if (strcmp(command, "--help") == 0 || strcmp(command, "-h") == 0 ||
      strcmp(command, "help") == 0) {
    const char *text = pw_main_help(argc > 2 ? argv[2] : NULL);
    if (!text) {
      return usage(NULL, "no such command: ", argv[2]);
    }
    fputs(text, stdout);
    return PW_EXIT_FINISHED;
  }
  if (argc < 2) {
    print_help(NULL);
    return PW_EXIT_USAGE;
  }
  return usage(NULL, "no such command: ", command);
}

int main(int argc, char **argv)
{
  pw_exit code = dispatch(argc, argv);
  if (fflush(stdout) != 0 && code == PW_EXIT_FINISHED) {
    fputs("error: the output could not be written in full\n", stderr);
    code = PW_EXIT_FAILED;
  }
  return code;
}
