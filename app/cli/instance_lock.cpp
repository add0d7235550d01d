#include "cli/instance_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>

#include <array>
#include <cerrno>
#include <sstream>
#include <system_error>

#include "store/store_files.hpp"

namespace interlock::cli {
namespace {

namespace fs = std::filesystem;

/** What a lock file says about its holder. */
struct Holder {
  std::string process;
  std::string url;
  std::string runtime_directory;
};

Holder read_holder(int file) {
  std::array<char, 8192> text{};
  const ssize_t length = pread(file, text.data(), text.size(), 0);
  std::istringstream lines(std::string(text.data(), length > 0 ? static_cast<std::size_t>(length) : 0));
  Holder holder;
  std::getline(lines, holder.process);
  std::getline(lines, holder.url);
  std::getline(lines, holder.runtime_directory);
  return holder;
}

/** An instance that was killed could not remove its private directory. */
void remove_leftovers(const Holder& holder) {
  const fs::path directory = holder.runtime_directory;
  if (directory.is_absolute() && directory.filename().string().starts_with("interlock-")) {
    std::error_code ignored;
    fs::remove_all(directory, ignored);
  }
}

}  // namespace

Result<InstanceLock> InstanceLock::take(const fs::path& directory) {
  // Whether this worked shows in the lock file.
  static_cast<void>(make_private_folder(directory));
  const fs::path path = directory / "lock";
  UniqueFd file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!file) {
    return failed(ExitCode::precondition, "the state directory cannot be used: " + path.string() + ": " +
                                              std::generic_category().message(errno) +
                                              "; choose another with --state");
  }
  const bool taken = flock(file.get(), LOCK_EX | LOCK_NB) == 0;
  const Holder holder = read_holder(file.get());
  if (!taken) {
    return failed(ExitCode::precondition, "another instance uses the state directory " + directory.string() +
                                              ": process " + holder.process + ", " + holder.url +
                                              "; stop it, or choose another --state and --port");
  }
  remove_leftovers(holder);
  return InstanceLock(std::move(file));
}

void InstanceLock::describe(const std::string& url, const fs::path& runtime_directory) const {
  const std::string text = std::to_string(getpid()) + '\n' + url + '\n' + runtime_directory.string() + '\n';
  // The lock holds with or without its description; without it, a second instance cannot name the first.
  [[maybe_unused]] const bool described =
      ftruncate(file_.get(), 0) == 0 &&
      pwrite(file_.get(), text.data(), text.size(), 0) == static_cast<ssize_t>(text.size());
}

InstanceLock::~InstanceLock() {
  if (file_) {
    [[maybe_unused]] const int emptied = ftruncate(file_.get(), 0);
  }
}

}  // namespace interlock::cli
