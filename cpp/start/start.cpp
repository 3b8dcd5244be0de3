// The commands `hexdbb` and `hexdbb-run`: they start Python while Ctrl-C is held back.
//
// Python prints a traceback for a Ctrl-C that meets it in its own first hundredths of a second, before any line of a
// program has run. A signal that is blocked waits, also across execv, until `hexdbb_start` can answer it in one line.

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#ifdef __APPLE__
#include <mach-o/dyld.h>
#endif

namespace {

constexpr int cannot_start = 127;  // as shells say it of a command that they do not find

// The folder that this program lies in, not that of a link to it: what it starts lies beside it.
std::filesystem::path own_folder(std::error_code& error) {
#ifdef __APPLE__
  char name[4096];
  uint32_t size = sizeof name;
  if (_NSGetExecutablePath(name, &size) != 0) error = std::make_error_code(std::errc::filename_too_long);
#else
  const char* name = "/proc/self/exe";
#endif
  return error ? std::filesystem::path() : std::filesystem::canonical(name, error).parent_path();
}

}  // namespace

int main(int count, char** words) {
  sigset_t interrupt;
  sigemptyset(&interrupt);
  sigaddset(&interrupt, SIGINT);
  sigprocmask(SIG_BLOCK, &interrupt, nullptr);

  std::error_code error;
  const std::string python_script = (own_folder(error) / "hexdbb-start").string();
  std::string program = HEXDBB_PROGRAM;
  if (!error) {
    std::vector<char*> arguments{const_cast<char*>(python_script.c_str()), program.data()};
    for (int each = 1; each < count; ++each) arguments.push_back(words[each]);
    arguments.push_back(nullptr);
    execv(python_script.c_str(), arguments.data());
    error = std::error_code(errno, std::generic_category());
  }
  std::fprintf(stderr, "error: %s cannot start %s: %s (install hexdbb again)\n", program.c_str(), python_script.c_str(),
               error.message().c_str());
  return cannot_start;
}
