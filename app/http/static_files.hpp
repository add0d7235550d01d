/**
 * @file
 * The console's files, and the documents below /docs.
 */
#pragma once

#include <filesystem>
#include <string>

#include "http/message.hpp"

namespace interlock::web {

class StaticFiles {
 public:
  /** Either may be empty: then there is no console, or there are no documents. */
  explicit StaticFiles(const std::filesystem::path& console, const std::filesystem::path& documents = {});

  /** The file of that path, "/" and "/docs/" being index.html; "/docs" leads there. Nothing outside of both
   * folders is ever served. 404 or 405 otherwise. */
  [[nodiscard]] Response serve(const Request& request) const;

 private:
  std::filesystem::path console_;
  std::filesystem::path documents_;
};

}  // namespace interlock::web
