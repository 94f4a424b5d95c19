// SPDX-License-Identifier: MIT
#include "lodestone/app/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

#include "lodestone/base/error.h"
#include "lodestone/base/unfinished_files.h"

namespace lodestone::app {
namespace {

std::atomic<bool> keep{false};
std::atomic<bool> signalled{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch lock-free atomics only");

void on_signal(int) {
  if (!keep) {
    remove_unfinished_files();
    ::_exit(int(ExitCode::interrupted));
  }
  signalled = true;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

void install_interrupt_handlers() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART;  // a signal must not fail a write of the frame before
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

KeepResults::KeepResults() : before_(keep.exchange(true)) {}
KeepResults::~KeepResults() {
  keep = before_;
}

bool interrupted() {
  return signalled;
}

}  // namespace lodestone::app
