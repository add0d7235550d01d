#include "http/static_files.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "http/same_origin.hpp"
#include "store/digest.hpp"

namespace interlock::web {
namespace {

namespace http = boost::beast::http;
namespace fs = std::filesystem;

constexpr std::array<std::pair<std::string_view, std::string_view>, 15> content_types{{
    {".css", "text/css; charset=utf-8"},
    {".csv", "text/csv; charset=utf-8"},
    {".html", "text/html; charset=utf-8"},
    {".ico", "image/x-icon"},
    {".jpg", "image/jpeg"},
    {".js", "text/javascript; charset=utf-8"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".pdf", "application/pdf"},
    {".png", "image/png"},
    {".svg", "image/svg+xml"},
    {".txt", "text/plain; charset=utf-8"},
    {".wasm", "application/wasm"},
    {".webmanifest", "application/manifest+json"},
    {".woff2", "font/woff2"},
}};

constexpr std::string_view documents_path = "/docs";
constexpr std::string_view documents_index = "/docs/";

constexpr const char* for_ever = "public, max-age=31536000, immutable";
constexpr const char* ask_again = "no-cache";

bool is_document(const std::string& path) {
  return path == documents_path || path.starts_with(documents_index);
}

std::string_view content_type_of(const fs::path& file) {
  const std::string extension = file.extension().string();
  const auto found = std::find_if(content_types.begin(), content_types.end(),
                                  [&](const auto& each) { return each.first == extension; });
  return found == content_types.end() ? "application/octet-stream" : found->second;
}

/** Vite names these by a hash of what is in them, such as /assets/index-Dc8Mo0lP.js. */
bool is_named_by_content(const fs::path& path) {
  constexpr std::size_t hash_length = 8;
  const std::string name = path.stem().string();
  return path.parent_path() == "/assets" && name.size() > hash_length &&
         name[name.size() - hash_length - 1] == '-';
}

/** What follows the name of a file where it is kept in that form. */
constexpr std::array<std::pair<Coding, std::string_view>, codings.size()> endings{
    {{Coding::identity, ""}, {Coding::brotli, ".br"}, {Coding::gzip, ".gz"}}};

/** The files below the folder by their path as a URL has it. */
std::map<std::string, fs::path> files_below(const fs::path& root) {
  std::map<std::string, fs::path> files;
  std::error_code error;
  fs::recursive_directory_iterator entry(root, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    const std::string path = "/" + entry->path().lexically_relative(root).generic_string();
    if (auto file = file_within(root, path)) {
      files.emplace(path, std::move(*file));
    }
  }
  if (error) {
    spdlog::error("cannot read all of {}: {}", root.string(), error.message());
  }
  return files;
}

/** Whether it is another file, compressed. */
bool is_compressed(const std::string& path, const std::map<std::string, fs::path>& files) {
  return std::ranges::any_of(endings, [&](const auto& each) {
    const std::string_view ending = each.second;
    return !ending.empty() && path.ends_with(ending) &&
           files.contains(path.substr(0, path.size() - ending.size()));
  });
}

class SharedBody : public FileBody {
 public:
  explicit SharedBody(std::shared_ptr<const std::string> bytes) : bytes_(std::move(bytes)) {}

  [[nodiscard]] std::uint64_t size() const override { return bytes_->size(); }

  boost::asio::awaitable<std::optional<std::string_view>> piece(std::uint64_t offset) override {
    co_return std::string_view(*bytes_).substr(offset, longest_piece);
  }

 private:
  std::shared_ptr<const std::string> bytes_;
};

/** An answer for that entity tag, with neither type nor body yet. */
FileResponse head_of(const Request& request, const std::string& tag, const char* cache_control) {
  FileResponse response{
      Response{has_already(request, tag) ? http::status::not_modified : http::status::ok, 11}, nullptr};
  response.head.set(http::field::etag, tag);
  response.head.set(http::field::cache_control, cache_control);
  return response;
}

std::string how_to_bring(bool is_document) {
  return is_document ? "Run `make docs`, and start interlock-app with --docs DIR, the built site."
                     : "Start interlock-app with --web DIR, the built console.";
}

}  // namespace

StaticFiles::StaticFiles(const fs::path& console, const fs::path& documents) : documents_(documents) {
  std::error_code error;
  const fs::path root = console.empty() ? console : fs::canonical(console, error);
  if (!root.empty()) {
    has_console_ = true;
    load_console(root);
  }
}

void StaticFiles::load_console(const fs::path& root) {
  const std::map<std::string, fs::path> files = files_below(root);
  for (const auto& [path, ignored] : files) {
    if (is_compressed(path, files)) {
      continue;
    }
    Forms forms;
    for (const auto& [coding, ending] : endings) {
      const auto file = files.find(path + std::string(ending));
      if (file != files.end()) {
        if (auto form = load(file->second)) {
          forms.emplace(coding, std::move(*form));
        }
      }
    }
    if (forms.contains(Coding::identity)) {
      console_.emplace(path, std::move(forms));
    }
  }
}

std::optional<StaticFiles::Form> StaticFiles::load(const fs::path& file) {
  std::error_code error;
  const std::uint64_t size = fs::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || !stream || size > most_bytes - bytes_) {
    spdlog::error("{} is not served: {}", file.string(),
                  size > most_bytes - bytes_ ? "the console is too large" : "it cannot be read");
    return std::nullopt;
  }
  auto bytes = std::make_shared<std::string>(size, '\0');
  stream.read(bytes->data(), static_cast<std::streamsize>(size));
  bytes->resize(static_cast<std::size_t>(stream.gcount()));
  bytes_ += bytes->size();
  constexpr std::size_t tag_length = 32;
  return Form{bytes, '"' + sha256_hex(*bytes).substr(0, tag_length) + '"'};
}

// GCC 12 fails on `co_await` within `?:`, and destroys temporaries beside it twice.
boost::asio::awaitable<AnyResponse> StaticFiles::serve(const Request& request) {
  const std::string path = path_of(request);
  std::optional<FileResponse> found;
  if (is_document(path)) {
    found = co_await find_document(request);
  } else {
    found = find_in_console(request, path);
  }
  co_return respond(request, path, std::move(found));
}

AnyResponse StaticFiles::respond(const Request& request, const std::string& path,
                                 std::optional<FileResponse> found) const {
  if (!found && path == documents_path && documents_.exist()) {
    // Without the slash the links of the first page would lead beside the documents.
    Response moved{http::status::permanent_redirect, 11};
    moved.set(http::field::location, std::string(documents_index));
    return moved;
  }
  if (!found) {
    const bool exists = is_document(path) ? documents_.exist() : has_console_;
    return problem_response({.status = Status::not_found,
                             .code = "NOT_FOUND",
                             .detail = "There is no " + path + ".",
                             .next_step = exists ? "" : how_to_bring(is_document(path))});
  }
  if (!is_safe(request.method())) {
    return problem_response(
        {.status = Status::method_not_allowed,
         .code = "METHOD_NOT_ALLOWED",
         .detail = path + " does not answer " + std::string(request.method_string()) + ".",
         .expected = "GET, HEAD",
         .headers = {{"Allow", "GET, HEAD"}}});
  }
  return std::move(*found);
}

std::optional<FileResponse> StaticFiles::find_in_console(const Request& request,
                                                         const std::string& path) const {
  const auto file = console_.find(path == "/" ? "/index.html" : path);
  if (file == console_.end()) {
    return std::nullopt;
  }
  const auto& [name, forms] = *file;
  Coding best = Coding::identity;
  int most = 0;
  for (const Coding coding : codings) {
    if (const int liked = liking(request, coding); forms.contains(coding) && liked > most) {
      best = coding;
      most = liked;
    }
  }
  const Form& form = forms.at(best);
  FileResponse response = head_of(request, form.tag, is_named_by_content(name) ? for_ever : ask_again);
  if (forms.size() > 1) {
    response.head.set(http::field::vary, "Accept-Encoding");
  }
  if (response.head.result() == http::status::ok) {
    response.head.set(http::field::content_type, content_type_of(name));
    if (best != Coding::identity) {
      response.head.set(http::field::content_encoding, name_of(best));
    }
    response.body = std::make_unique<SharedBody>(form.bytes);
  }
  return response;
}

boost::asio::awaitable<std::optional<FileResponse>> StaticFiles::find_document(const Request& request) {
  std::string path = path_of(request).substr(documents_path.size());
  if (path == "/") {
    path = "/index.html";
  }
  auto document = co_await documents_.find(std::move(path));
  if (!document) {
    co_return std::nullopt;
  }
  FileResponse response = head_of(request, document->tag(), ask_again);
  if (response.head.result() == http::status::ok) {
    response.head.set(http::field::content_type, content_type_of(document->file));
    response.body = documents_.body_of(std::move(*document));
  }
  co_return std::move(response);
}

}  // namespace interlock::web
