#include "http/static_files.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "http/same_origin.hpp"

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

std::string_view content_type_of(const fs::path& file) {
  const std::string extension = file.extension().string();
  const auto found = std::find_if(content_types.begin(), content_types.end(),
                                  [&](const auto& each) { return each.first == extension; });
  return found == content_types.end() ? "application/octet-stream" : found->second;
}

bool lies_within(const fs::path& root, const fs::path& file) {
  return std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end();
}

/** The regular file that the path names, links resolved, if it lies within the root. */
std::optional<fs::path> file_of(const fs::path& root, const std::string& path) {
  if (root.empty() || path.empty() || path.find('\0') != std::string::npos) {
    return std::nullopt;
  }
  std::error_code error;
  const fs::path wanted = root / fs::path(path == "/" ? "/index.html" : path).relative_path();
  const fs::path file = fs::canonical(wanted, error);
  if (error || !lies_within(root, file) || !fs::is_regular_file(file, error)) {
    return std::nullopt;
  }
  return file;
}

fs::path canonical_or_empty(const fs::path& folder) {
  std::error_code error;
  return folder.empty() ? folder : fs::canonical(folder, error);
}

std::string how_to_bring(bool is_document) {
  return is_document ? "Run `make docs`, and start interlock-app with --docs DIR, the built site."
                     : "Start interlock-app with --web DIR, the built console.";
}

}  // namespace

StaticFiles::StaticFiles(const fs::path& console, const fs::path& documents)
    : console_(canonical_or_empty(console)), documents_(canonical_or_empty(documents)) {}

Response StaticFiles::serve(const Request& request) const {
  const std::string path = path_of(request);
  const bool is_document = path == documents_path || path.starts_with(documents_index);
  const fs::path& root = is_document ? documents_ : console_;
  const auto file = file_of(root, is_document ? path.substr(documents_path.size()) : path);
  if (!file && path == documents_path && !documents_.empty()) {
    // Without the slash the links of the first page would lead beside the documents.
    Response moved{Status::permanent_redirect, 11};
    moved.set(http::field::location, std::string(documents_index));
    return moved;
  }
  if (!file) {
    return problem_response({.status = Status::not_found,
                             .code = "NOT_FOUND",
                             .detail = "There is no " + path + ".",
                             .next_step = root.empty() ? how_to_bring(is_document) : ""});
  }
  if (!is_safe(request.method())) {
    return problem_response(
        {.status = Status::method_not_allowed,
         .code = "METHOD_NOT_ALLOWED",
         .detail = path + " does not answer " + std::string(request.method_string()) + ".",
         .expected = "GET, HEAD",
         .headers = {{"Allow", "GET, HEAD"}}});
  }
  std::ifstream stream(*file, std::ios::binary);
  Response response{Status::ok, 11};
  response.set(http::field::content_type, std::string(content_type_of(*file)));
  response.set(http::field::cache_control, "no-cache");
  response.body() = std::string(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  return response;
}

}  // namespace interlock::web
