// SPDX-License-Identifier: MIT
#include "process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <iterator>

namespace lodestone::cli {
namespace {
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// A pipe, or a terminal, whose ends close themselves.
class Pipe {
 public:
  explicit Pipe(bool terminal = false) {
    if (!terminal) {
      EXPECT_EQ(::pipe2(ends_, O_CLOEXEC), 0);
      return;
    }
    ends_[0] = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    EXPECT_EQ(::grantpt(ends_[0]), 0);
    EXPECT_EQ(::unlockpt(ends_[0]), 0);
    ends_[1] = ::open(::ptsname(ends_[0]), O_RDWR | O_NOCTTY | O_CLOEXEC);
    EXPECT_GE(ends_[1], 0);
  }
  ~Pipe() {
    close_end(0);
    close_end(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  int read_end() const { return ends_[0]; }
  int write_end() const { return ends_[1]; }
  void close_end(int end) {
    if (ends_[end] >= 0) ::close(ends_[end]);
    ends_[end] = -1;
  }

 private:
  int ends_[2] = {-1, -1};
};

fs::path cache_folder() {
  static const fs::path folder =
      fs::temp_directory_path() / ("lodestone-cli-cache-" + std::to_string(::getuid()));
  return folder;
}

[[noreturn]] void become_program(const std::vector<std::string>& arguments, const ProcessOptions& options,
                                 const Pipe& out, const Pipe& err) {
  ::dup2(options.output.empty() ? out.write_end() : ::open(options.output.c_str(), O_WRONLY | O_CLOEXEC),
         STDOUT_FILENO);
  ::dup2(err.write_end(), STDERR_FILENO);
  ::setenv("LODESTONE_CACHE", cache_folder().c_str(), 1);
  for (const auto& [name, value] : options.environment) ::setenv(name.c_str(), value.c_str(), 1);
  std::vector<char*> pointers = {const_cast<char*>(LODESTONE_PROGRAM)};
  for (const std::string& argument : arguments) pointers.push_back(const_cast<char*>(argument.c_str()));
  pointers.push_back(nullptr);
  ::execv(LODESTONE_PROGRAM, pointers.data());
  ::_exit(127);
}

// Appends what stands in the pipe; false at its end.
bool drain(int file, std::string& text) {
  char buffer[4096];
  const ssize_t count = ::read(file, buffer, sizeof buffer);
  if (count > 0) text.append(buffer, size_t(count));
  return count > 0;
}

// Collects the output until both pipes end, sending the signal and keeping the time limit meanwhile.
void collect(pid_t child, const ProcessOptions& options, Pipe& out, Pipe& err, Result& result) {
  const Clock::time_point end = Clock::now() + options.limit;
  Clock::time_point signalled_at{};
  bool signalled = !options.signal_when, killed = false, out_open = true, err_open = true;
  while (out_open || err_open) {
    pollfd files[2] = {{out_open ? out.read_end() : -1, POLLIN, 0},
                       {err_open ? err.read_end() : -1, POLLIN, 0}};
    ::poll(files, 2, 5);
    if (files[0].revents != 0) out_open = drain(out.read_end(), result.out);
    if (files[1].revents != 0) err_open = drain(err.read_end(), result.err);
    if (!signalled && options.signal_when(result)) {
      ::kill(child, options.signal);
      signalled = true;
      signalled_at = Clock::now();
    }
    if (!killed && Clock::now() > end) {
      ADD_FAILURE() << "the program did not end within " << options.limit.count() << " s";
      ::kill(child, SIGKILL);
      killed = true;
    }
  }
  if (signalled_at != Clock::time_point{})
    result.seconds_after_signal = std::chrono::duration<double>(Clock::now() - signalled_at).count();
}

}  // namespace

Result run(const std::vector<std::string>& arguments, const ProcessOptions& options) {
  Pipe out, err(options.terminal);
  const pid_t child = ::fork();
  if (child == 0) become_program(arguments, options, out, err);
  out.close_end(1);
  err.close_end(1);
  Result result;
  collect(child, options, out, err, result);
  int status = 0;
  ::waitpid(child, &status, 0);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

void CommandLine::SetUp() {
  const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
  folder_ = fs::temp_directory_path() /
            (std::string("lodestone-cli-") + test->name() + "-" + std::to_string(::getpid()));
  fs::create_directories(folder_);
}

void CommandLine::TearDown() {
  fs::remove_all(folder_);
}

std::vector<std::string> CommandLine::files() const {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder_))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string read_text(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  EXPECT_TRUE(stream.is_open()) << path;
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_text(const fs::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

std::vector<std::string> tiny_render(const std::string& output, const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"render", "builtin:tiny", "-o",       output,
                                        "--size", "24x16",        "--device", "cpu"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

}  // namespace lodestone::cli
