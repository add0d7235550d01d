#include "http/documents.hpp"

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <fstream>
#include <system_error>
#include <type_traits>
#include <utility>

namespace interlock::web {
namespace {

namespace asio = boost::asio;
namespace fs = std::filesystem;

bool lies_within(const fs::path& root, const fs::path& file) {
  return std::mismatch(root.begin(), root.end(), file.begin(), file.end()).first == root.end();
}

std::optional<Document> found(const fs::path& file) {
  std::error_code error;
  Document document{.file = file, .size = fs::file_size(file, error), .changed = {}};
  if (!error) {
    document.changed = fs::last_write_time(file, error);
  }
  return error ? std::nullopt : std::optional(document);
}

std::optional<std::string> read_piece(const Document& document, std::uint64_t offset) {
  std::ifstream stream(document.file, std::ios::binary);
  std::string piece(std::min<std::uint64_t>(FileBody::longest_piece, document.size - offset), '\0');
  stream.seekg(static_cast<std::streamoff>(offset));
  stream.read(piece.data(), static_cast<std::streamsize>(piece.size()));
  return stream && found(document.file) == document ? std::optional(std::move(piece)) : std::nullopt;
}

template <typename Work>
using ResultOf = asio::awaitable<std::invoke_result_t<Work>>;

template <typename Work>
ResultOf<Work> in_pool(Work work) {
  co_return work();
}

/** What `work()` gives, an optional, run in a thread of the pool. It is not `WorkPool`, in whose queue
 * documents would keep logins waiting. Here each connection waits for one piece at most. */
template <typename Work>
ResultOf<Work> run(asio::thread_pool& pool, Work work) {
  co_return co_await asio::co_spawn(pool, in_pool(std::move(work)), asio::use_awaitable);
}

class DocumentBody : public FileBody {
 public:
  DocumentBody(asio::thread_pool& reader, Document document)
      : reader_(reader), document_(std::move(document)) {}

  [[nodiscard]] std::uint64_t size() const override { return document_.size; }

  asio::awaitable<std::optional<std::string_view>> piece(std::uint64_t offset) override {
    auto read = [document = document_, offset] { return read_piece(document, offset); };
    piece_ = co_await run(reader_, std::move(read));
    co_return piece_ ? std::optional<std::string_view>(*piece_) : std::nullopt;
  }

 private:
  asio::thread_pool& reader_;
  Document document_;
  std::optional<std::string> piece_;
};

}  // namespace

std::string Document::tag() const {
  return "W/\"" + std::to_string(size) + "-" + std::to_string(changed.time_since_epoch().count()) + "\"";
}

Documents::Documents(const fs::path& folder) {
  std::error_code error;
  root_ = folder.empty() ? folder : fs::canonical(folder, error);
  if (!root_.empty()) {
    reader_ = std::make_unique<asio::thread_pool>(1);
  }
}

asio::awaitable<std::optional<Document>> Documents::find(std::string path) {
  if (!exist()) {
    co_return std::nullopt;
  }
  auto look = [root = root_, path = std::move(path)] {
    const auto file = file_within(root, path);
    return file ? found(*file) : std::nullopt;
  };
  co_return co_await run(*reader_, std::move(look));
}

std::unique_ptr<FileBody> Documents::body_of(Document document) {
  return std::make_unique<DocumentBody>(*reader_, std::move(document));
}

std::optional<fs::path> file_within(const fs::path& root, const std::string& path) {
  if (root.empty() || path.empty() || path.find('\0') != std::string::npos) {
    return std::nullopt;
  }
  std::error_code error;
  fs::path file = fs::canonical(root / fs::path(path).relative_path(), error);
  if (error || !lies_within(root, file) || !fs::is_regular_file(file, error)) {
    return std::nullopt;
  }
  return file;
}

}  // namespace interlock::web
