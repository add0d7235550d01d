/**
 * @file
 * The directory of one run: sockets and the compiled configuration.
 */
#pragma once

#include <filesystem>
#include <string>

#include "cli/exit_code.hpp"
#include "cli/unique_fd.hpp"

namespace interlock::cli {

/** Removes what a run leaves in it when it goes: the whole directory, or, in one that was given, its own
 * files. */
class RuntimeDirectory {
 public:
  /** A new private directory under $XDG_RUNTIME_DIR, or under the system's temporary directory. */
  static Result<RuntimeDirectory> make_private(const std::string& robot_name);

  /** A given directory, made if missing and held against other runs. Files of an earlier run in it are
   * removed. */
  static Result<RuntimeDirectory> use(const std::filesystem::path& directory, const std::string& robot_name);

  RuntimeDirectory(RuntimeDirectory&& other) noexcept;
  RuntimeDirectory& operator=(RuntimeDirectory&&) = delete;
  ~RuntimeDirectory();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool is_private() const { return !hold_; }
  [[nodiscard]] std::filesystem::path bus() const { return path_ / "bus.sock"; }
  [[nodiscard]] std::filesystem::path control() const { return path_ / "control.sock"; }
  [[nodiscard]] std::filesystem::path link() const { return path_ / "link.sock"; }
  [[nodiscard]] std::filesystem::path config() const { return path_ / (robot_name_ + ".ilkc"); }

 private:
  RuntimeDirectory(std::filesystem::path path, std::string robot_name, UniqueFd hold)
      : path_(std::move(path)), robot_name_(std::move(robot_name)), hold_(std::move(hold)) {}

  void remove_own_files() const;

  std::filesystem::path path_;
  std::string robot_name_;
  UniqueFd hold_; /**< lock on a given directory; none on a private one */
};

}  // namespace interlock::cli
