/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "io/run_signals.h"

#include <signal.h>
#include <string.h>

enum { STOPS = 3, SIGNALS = 5 };

static const int caught[SIGNALS] = {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ};
static struct sigaction before[SIGNALS];
static volatile sig_atomic_t stop;

static void note(int signal)
{
  (void)signal;
  stop = 1;
}

void pw_run_signals_catch(void)
{
  stop = 0;
  for (int i = 0; i < SIGNALS; i++) {
    struct sigaction action;
    memset(&action, 0, sizeof action);
    sigemptyset(&action.sa_mask);
    action.sa_handler = i < STOPS ? note : SIG_IGN;
    action.sa_flags = i < STOPS ? (int)SA_RESETHAND | SA_RESTART : 0;
    sigaction(caught[i], NULL, &before[i]);
    if (before[i].sa_handler != SIG_IGN) {
      sigaction(caught[i], &action, NULL);
    }
  }
}

bool pw_run_signals_stop(void)
{
  return stop != 0;
}

void pw_run_signals_restore(void)
{
  for (int i = 0; i < SIGNALS; i++) {
    sigaction(caught[i], &before[i], NULL);
  }
}
