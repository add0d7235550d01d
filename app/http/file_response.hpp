/**
 * @file
 * An answer with a file: its bytes are shared with other connections, or come from the disk, and go out in
 * pieces, so that connections take turns.
 */
#pragma once

#include <boost/asio/awaitable.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <variant>

#include "http/message.hpp"

namespace interlock::web {

/** The bytes of one answer. */
class FileBody {
 public:
  /** So many bytes of a file are sent before it is the turn of another connection. */
  static constexpr std::size_t longest_piece = 16u * 1024u;

  FileBody() = default;
  FileBody(const FileBody&) = delete;
  FileBody& operator=(const FileBody&) = delete;
  virtual ~FileBody() = default;

  /** Bytes in all. */
  [[nodiscard]] virtual std::uint64_t size() const = 0;

  /**
   * Bytes from `offset` on, at least one and at most `longest_piece` where `offset` is less than the size;
   * valid until the next call. Nothing when the file can no longer be read, or is another one meanwhile.
   */
  virtual boost::asio::awaitable<std::optional<std::string_view>> piece(std::uint64_t offset) = 0;
};

/** Status and headers, and the bytes. */
struct FileResponse {
  Response head;                  /**< without a body and its length */
  std::unique_ptr<FileBody> body; /**< null: the client has it already */
};

/** What the server answers. */
using AnyResponse = std::variant<Response, FileResponse>;

}  // namespace interlock::web
