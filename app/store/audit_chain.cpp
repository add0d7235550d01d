#include "store/audit_chain.hpp"

#include <nlohmann/json.hpp>

#include "store/digest.hpp"

namespace interlock {
namespace {

/** Names the encoding within what is hashed: another one gets another name. */
constexpr const char* encoding_name = "interlock-audit-1";

void append_field(std::string& encoding, const std::string& bytes) {
  encoding += std::to_string(bytes.size()) + ':' + bytes + ',';
}

std::string text_of(const std::optional<std::int64_t>& number) {
  return number ? std::to_string(*number) : "";
}

nlohmann::json json_of(const std::optional<std::int64_t>& number) {
  return number ? nlohmann::json(*number) : nlohmann::json();
}

}  // namespace

nlohmann::json to_json(const AuditRecord& record) {
  // A forged record may hold anything; it is shown as the text that it is.
  const auto detail = nlohmann::json::parse(record.detail, nullptr, false);
  return {{"number", record.number},
          {"time", record.time},
          {"tick", json_of(record.tick)},
          {"actor", record.actor},
          {"session", json_of(record.session)},
          {"kind", record.kind},
          {"detail", detail.is_object() ? detail : nlohmann::json{{"unreadable", record.detail}}},
          {"hash", record.hash}};
}

std::string canonical_encoding(const AuditRecord& record, const std::string& previous_hash) {
  std::string encoding;
  for (const std::string& field :
       {std::string(encoding_name), previous_hash, std::to_string(record.number), record.time,
        text_of(record.tick), record.actor, text_of(record.session), record.kind, record.detail}) {
    append_field(encoding, field);
  }
  return encoding;
}

std::string audit_hash(const AuditRecord& record, const std::string& previous_hash) {
  return sha256_hex(canonical_encoding(record, previous_hash));
}

tl::expected<void, AuditBreak> AuditChain::follow(const AuditRecord& record) {
  const std::int64_t expected_number = head_.number + 1;
  if (record.number != expected_number) {
    return tl::unexpected(AuditBreak{
        expected_number, "is missing: record " + std::to_string(record.number) + " stands in its place"});
  }
  const std::string expected_hash = audit_hash(record, head_.hash);
  if (record.hash != expected_hash) {
    return tl::unexpected(
        AuditBreak{expected_number, "was changed, or does not belong behind the one before: its hash is " +
                                        record.hash + ", but its contents give " + expected_hash});
  }
  head_ = {record.number, record.hash};
  return {};
}

}  // namespace interlock
