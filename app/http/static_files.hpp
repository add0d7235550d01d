/**
 * @file
 * The console's files.
 */
#pragma once

#include <filesystem>
#include <string>

#include "http/message.hpp"

namespace interlock::web {

class StaticFiles {
 public:
  /** `root` may be empty: then there is no console. */
  explicit StaticFiles(const std::filesystem::path& root);

  /** The file of that path, "/" being index.html. Nothing outside of the root is ever served. 404 or 405
   * otherwise. */
  [[nodiscard]] Response serve(const Request& request) const;

 private:
  std::filesystem::path root_;
};

}  // namespace interlock::web
