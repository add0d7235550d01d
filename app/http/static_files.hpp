/**
 * @file
 * The console's files, and the documents below /docs.
 *
 * The console is read into memory once, at the start, with the forms that its build compressed (x.js.br and
 * x.js.gz beside x.js): whoever asks for it costs no disk, and a console that is built anew is seen by the
 * next start. Documents stay on the disk.
 */
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "http/documents.hpp"
#include "http/file_response.hpp"
#include "http/negotiation.hpp"

namespace interlock::web {

class StaticFiles {
 public:
  /** What is kept of a console at most; files beyond are logged and not served. */
  static constexpr std::uint64_t most_bytes = 16u * 1024u * 1024u;

  /** Either may be empty: then there is no console, or there are no documents. */
  explicit StaticFiles(const std::filesystem::path& console, const std::filesystem::path& documents = {});

  /** The file of that path, "/" and "/docs/" being index.html; "/docs" leads there. Nothing outside of both
   * folders is ever served. 404 or 405 otherwise. */
  boost::asio::awaitable<AnyResponse> serve(const Request& request);

 private:
  /** One form of a file. */
  struct Form {
    std::shared_ptr<const std::string> bytes;
    std::string tag; /**< entity tag: of these bytes, so each form has one of its own */
  };
  using Forms = std::map<Coding, Form>;

  void load_console(const std::filesystem::path& root);
  /** Nothing when it cannot be read or is too much. */
  std::optional<Form> load(const std::filesystem::path& file);
  [[nodiscard]] std::optional<FileResponse> find_in_console(const Request& request,
                                                            const std::string& path) const;
  boost::asio::awaitable<std::optional<FileResponse>> find_document(const Request& request);
  [[nodiscard]] AnyResponse respond(const Request& request, const std::string& path,
                                    std::optional<FileResponse> found) const;

  std::map<std::string, Forms> console_; /**< by path; each has the form `identity` */
  bool has_console_ = false;
  std::uint64_t bytes_ = 0; /**< of the console in memory */
  Documents documents_;
};

}  // namespace interlock::web
