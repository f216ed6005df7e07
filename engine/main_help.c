/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "engine/main.h"

#include <string.h>

#define EXIT_STATUS                                                                                \
  "\nExit status:\n"                                                                               \
  "  0    finished\n"                                                                              \
  "  1    wrong command line, or the output folder holds a run already\n"                          \
  "  2    bad scene or other input; nothing was written\n"                                         \
  "  3    the run failed; the last good checkpoint is kept\n"                                      \
  "  130  interrupted; a checkpoint was written, --resume goes on from it\n"

static const char help_program[] =
    "Pilewright simulates how piles are driven into soil, with the material point method.\n"
    "\n"
    "usage: pilewright COMMAND ...\n"
    "\n"
    "  run SCENE.yaml     run a scene: pictures, histories, ParaView files, checkpoints\n"
    "  check SCENE.yaml   read and set up a scene, say what it would do, write nothing\n"
    "  element TEST.yaml  laboratory tests of a material: triaxial, oedometer, shear, any path\n"
    "  keys               every key a scene may hold: unit, default, range, meaning\n"
    "  list               materials, effects and choices of the method\n"
    "  COMMAND --help     more about a command\n"
    "  --version          version and source revision\n"
    "  --help             this text\n"
    "\n"
    "Examples:\n"
    "  pilewright check cases/hammered_pile/frictional.yaml\n"
    "  pilewright run cases/hammered_pile/frictional.yaml --threads 2\n"
    "  pilewright run my_pile.yaml --set hammer.count=40 --out out/forty_blows\n" EXIT_STATUS;

static const char help_run[] =
    "usage: pilewright run SCENE.yaml [options]\n"
    "\n"
    "Run a scene from its start to time.end_s.\n"
    "\n"
    "  --out DIR             output folder; default: out/NAME, from the scene file's name (for\n"
    "                        a file called scene.yaml: from its folder's name)\n"
    "  --threads N           OpenMP threads; default: OMP_NUM_THREADS or all cores. Results are\n"
    "                        bitwise the same on any number\n"
    "  --set key.path=value  change one key of the scene; may be repeated. Entries of lists are\n"
    "                        counted from 0: boundary.0.fix_x=false\n"
    "  --resume              go on from the folder's checkpoint, with the same scene; the result\n"
    "                        is bitwise that of an uninterrupted run. Without a checkpoint the\n"
    "                        run starts from its beginning\n"
    "  --force               remove the run that the folder holds and start over\n"
    "  --quiet               print only errors and the last line\n"
    "\n"
    "Written to the folder: summary.json, history.csv, checkpoint.h5, pictures/*.png and\n"
    "paraview/run.pvd. A checkpoint is written at the start and the end, every\n"
    "output.checkpoint_every_s of simulated time and every 30 s of waiting. Ctrl-C ends the\n"
    "step, writes a checkpoint and stops; after a crash the last checkpoint is whole.\n"
    "Threads are bound to cores when the run takes most of the machine; set OMP_PROC_BIND or\n"
    "OMP_PLACES to have it otherwise.\n"
    "\n"
    "Examples:\n"
    "  pilewright run cases/hammered_pile/penalty.yaml --threads 2\n"
    "  pilewright run pile.yaml --set grid.cell_m=0.25 --set time.end_s=2 --out out/coarse\n"
    "  pilewright run pile.yaml --out out/coarse --resume\n"
    "  pilewright run cases/vane_shear/scene.yaml --set implicit.fbar=none\n" EXIT_STATUS;

static const char help_check[] =
    "usage: pilewright check SCENE.yaml [--threads N] [--set key.path=value]...\n"
    "\n"
    "Read and set up a scene without running it, and print the effects with the places in a\n"
    "step where they act, the fields and bytes of a point, the sizes of cells, points, nodes,\n"
    "elements, blocks and colours, the first stable step, and estimates of steps, memory and\n"
    "time. Of a solid scene: bodies, mesh, equations, and the time that one Newton iteration\n"
    "takes. Nothing is written. All errors of a scene are printed at once, as\n"
    "file:line:column.\n"
    "\n"
    "Examples:\n"
    "  pilewright check pile.yaml --set grid.cell_m=0.0625\n"
    "  pilewright check pile.yaml --set 'grid.fine_x_m=[0,1]' --set grid.growth=1.1\n"
    "\n"
    "Exit status: 0 the scene can be run, 1 wrong command line, 2 bad scene.\n";

static const char help_element[] =
    "usage: pilewright element TEST.yaml [options]\n"
    "\n"
    "Run laboratory tests on one element of a material, without a mesh: isotropic and\n"
    "oedometric compression, triaxial, biaxial and simple shear tests, drained or not, mixed\n"
    "control of strain and stress, and strain paths from CSV files, one stage after another.\n"
    "Materials are written as in a scene.\n"
    "\n"
    "  --out DIR             output folder; default: out/NAME, from the test file's name\n"
    "  --set key.path=value  change one key of the test; may be repeated: stages.0.steps=10\n"
    "  --keys                print the keys of a test file\n"
    "\n"
    "Written to the folder: element.csv, with the units in its column names, and curves as PNG\n"
    "and SVG files in pictures/. All errors of a test are printed at once, as\n"
    "file:line:column.\n"
    "\n"
    "Example:\n"
    "  pilewright element cases/element_tests/triaxial_clay.yaml --out out/triaxial\n"
    "\n"
    "Exit status: 0 finished, 1 wrong command line, 2 bad test, 3 a step cannot be made (the\n"
    "rows before it are written).\n";

static const char help_keys[] =
    "usage: pilewright keys\n"
    "\n"
    "Print every key of a scene file with its unit, default, range and meaning, from the tables\n"
    "by which scenes are read.\n";

static const char help_list[] =
    "usage: pilewright list\n"
    "\n"
    "Print the materials, effects and choices of the method that scenes can name.\n";

const char *pw_main_help(const char *command)
{
  static const struct {
    const char *command, *text;
  } row[] = {{"run", help_run},
             {"check", help_check},
             {"element", help_element},
             {"keys", help_keys},
             {"list", help_list}};

  if (!command) {
    return help_program;
  }
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    if (strcmp(row[i].command, command) == 0) {
      return row[i].text;
    }
  }
  return NULL;
}
