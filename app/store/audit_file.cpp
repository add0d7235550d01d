#include "store/audit_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

namespace interlock {
namespace {

namespace fs = std::filesystem;
using Kind = StoreError::Kind;

constexpr const char* format_name = "interlock-audit-1";

StoreError problem_with(Kind kind, const fs::path& file, const std::string& problem) {
  return {kind, file.string() + ": " + problem, "", "", "choose another file"};
}

/** Every field as it was hashed; `detail` stays the text that it is. */
nlohmann::json line_of(const AuditRecord& record) {
  nlohmann::json line = to_json(record);
  line["detail"] = record.detail;
  return line;
}

std::optional<std::int64_t> optional_number(const nlohmann::json& value) {
  return value.is_null() ? std::nullopt : std::optional(value.get<std::int64_t>());
}

AuditRecord record_of(const nlohmann::json& line) {
  return {line.at("number").get<std::int64_t>(), line.at("time").get<std::string>(),
          optional_number(line.at("tick")),      line.at("actor").get<std::string>(),
          optional_number(line.at("session")),   line.at("kind").get<std::string>(),
          line.at("detail").get<std::string>(),  line.at("hash").get<std::string>()};
}

bool write_all(int file, const std::string& text) {
  std::size_t written = 0;
  while (written < text.size()) {
    const ssize_t count = write(file, text.data() + written, text.size() - written);
    if (count <= 0) {
      return false;
    }
    written += static_cast<std::size_t>(count);
  }
  return fsync(file) == 0;
}

/** Throws nlohmann::json::exception for what is no such file. */
tl::expected<AuditHead, AuditBreak> follow(std::istream& lines, const std::optional<std::string>& noted) {
  std::string line;
  std::getline(lines, line);
  const nlohmann::json first = nlohmann::json::parse(line);
  if (first.at("format") != format_name) {
    throw nlohmann::json::other_error::create(501, "another format", &first);
  }
  AuditChain chain(
      {first.at("behind_number").get<std::int64_t>(), first.at("behind_hash").get<std::string>()});
  bool noted_found = !noted || *noted == chain.head().hash;
  while (std::getline(lines, line)) {
    if (const auto followed = chain.follow(record_of(nlohmann::json::parse(line))); !followed) {
      return tl::unexpected(followed.error());
    }
    noted_found = noted_found || *noted == chain.head().hash;
  }
  if (!noted_found) {
    return tl::unexpected(
        AuditBreak{chain.head().number + 1, "is missing: no record has the hash " + *noted});
  }
  return chain.head();
}

}  // namespace

Stored<void> write_audit_file(const fs::path& path, const AuditHead& before,
                              const std::vector<AuditRecord>& records) {
  std::string text =
      nlohmann::json{{"format", format_name}, {"behind_number", before.number}, {"behind_hash", before.hash}}
          .dump() +
      '\n';
  for (const AuditRecord& record : records) {
    // A forged record may hold anything; what is no UTF-8 then fails to verify, as it should.
    text += line_of(record).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
  }
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (file < 0) {
    return tl::unexpected(
        problem_with(errno == EEXIST ? Kind::exists : Kind::unavailable, path, std::strerror(errno)));
  }
  const bool written = write_all(file, text);
  const int reason = errno;
  close(file);
  if (!written) {
    unlink(path.c_str());
    return tl::unexpected(problem_with(Kind::unavailable, path, std::strerror(reason)));
  }
  return {};
}

Stored<tl::expected<AuditHead, AuditBreak>> verify_audit_file(const fs::path& path,
                                                              const std::optional<std::string>& noted) {
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    return tl::unexpected(problem_with(Kind::unavailable, path, std::strerror(errno)));
  }
  try {
    return follow(file, noted);
  } catch (const nlohmann::json::exception& error) {
    return tl::unexpected(
        problem_with(Kind::damaged, path, std::string("no exported audit: ") + error.what()));
  }
}

}  // namespace interlock
