/**
 * @file
 * The documents below a folder. They can be many and large, so they stay on the disk, which is read in a
 * thread of its own: the network never waits for it.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/thread_pool.hpp>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "http/file_response.hpp"

namespace interlock::web {

/** One document, as it was when it was found. */
struct Document {
  std::filesystem::path file;
  std::uint64_t size = 0;
  std::filesystem::file_time_type changed;

  bool operator==(const Document&) const = default;

  /** Entity tag; weak, for nobody has read the bytes. */
  [[nodiscard]] std::string tag() const;
};

/** Belongs to the network thread. */
class Documents {
 public:
  /** Empty: there are none. */
  explicit Documents(const std::filesystem::path& folder);

  /** Whether there is a folder of documents. */
  [[nodiscard]] bool exist() const { return reader_ != nullptr; }

  /** The document of that path, links resolved, if it is a regular file within the folder. */
  boost::asio::awaitable<std::optional<Document>> find(std::string path);

  /** The document's bytes, as long as it stays the same. */
  std::unique_ptr<FileBody> body_of(Document document);

 private:
  std::filesystem::path root_;
  std::unique_ptr<boost::asio::thread_pool> reader_; /**< one thread; null without documents */
};

/** The regular file that the path names below the root, links resolved, if it lies within the root. */
std::optional<std::filesystem::path> file_within(const std::filesystem::path& root, const std::string& path);

}  // namespace interlock::web
