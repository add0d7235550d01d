#include "cli/instance_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

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
  std::string runtime_directory; /**< a private one; else empty */
  std::string black_box;         /**< socket */
};

Holder read_holder(int file) {
  std::array<char, 8192> text{};
  const ssize_t length = pread(file, text.data(), text.size(), 0);
  std::istringstream lines(std::string(text.data(), length > 0 ? static_cast<std::size_t>(length) : 0));
  Holder holder;
  std::getline(lines, holder.process);
  std::getline(lines, holder.url);
  std::getline(lines, holder.runtime_directory);
  std::getline(lines, holder.black_box);
  return holder;
}

/** An instance that was killed could not remove its private directory. What somebody else wrote is not
 * followed. */
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
  FileDescriptor file(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!file) {
    return failed(ExitCode::precondition, "the state directory cannot be used: " + path.string() + ": " +
                                              std::generic_category().message(errno) +
                                              "; choose another with --state");
  }
  const bool taken = flock(file.get(), LOCK_EX | LOCK_NB) == 0;
  const Holder holder = read_holder(file.get());
  struct stat status{};
  const bool is_own = fstat(file.get(), &status) == 0 && status.st_uid == geteuid();
  if (!taken && !is_own) {
    return failed(ExitCode::precondition, path.string() +
                                              " belongs to another user, who keeps it locked; remove it, or "
                                              "choose another --state");
  }
  if (!taken) {
    return failed(ExitCode::precondition, "another instance uses the state directory " + directory.string() +
                                              ": process " + holder.process + ", " + holder.url +
                                              "; stop it, or choose another --state and --port");
  }
  if (is_own) {
    remove_leftovers(holder);
  }
  return InstanceLock(std::move(file));
}

void InstanceLock::describe(const std::string& url, const fs::path& runtime_directory,
                            const fs::path& black_box) const {
  const std::string text = std::to_string(getpid()) + '\n' + url + '\n' + runtime_directory.string() + '\n' +
                           black_box.string() + '\n';
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

std::optional<fs::path> running_black_box(const fs::path& directory) {
  const FileDescriptor file(open((directory / "lock").c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW));
  const std::string black_box = file ? read_holder(file.get()).black_box : "";
  return black_box.empty() ? std::nullopt : std::optional<fs::path>(black_box);
}

}  // namespace interlock::cli
