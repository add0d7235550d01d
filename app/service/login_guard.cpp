#include "service/login_guard.hpp"

#include <algorithm>
#include <utility>

#include "store/digest.hpp"

namespace interlock {
namespace {

constexpr unsigned free_attempts_of_pair = 3;
constexpr unsigned free_attempts_of_address = 64;

/** Attempts of one address, or of one pair of address and name. */
struct Attempts {
  unsigned wrong = 0;       /**< in a row; those that are under way count */
  std::size_t underway = 0; /**< waiting or being judged */
  SteadyTime last;
};

/** A browser in which somebody has logged in. */
struct Browser {
  std::string name;
  SteadyTime last;
};

template <typename Entry>
using Table = std::map<std::string, Entry>;

/** Makes room for one more. */
template <typename Entry, typename MayGo>
void make_room(Table<Entry>& table, MayGo may_go) {
  if (table.size() < LoginGuard::capacity) {
    return;
  }
  auto oldest = table.end();
  for (auto each = table.begin(); each != table.end(); ++each) {
    if (may_go(each->second) && (oldest == table.end() || each->second.last < oldest->second.last)) {
      oldest = each;
    }
  }
  if (oldest != table.end()) {
    table.erase(oldest);
  }
}

/** 1 s after the last free attempt, then doubled up to the longest. */
std::chrono::seconds delay_after(unsigned wrong, unsigned free_attempts) {
  if (wrong < free_attempts) {
    return std::chrono::seconds(0);
  }
  const unsigned doublings = std::min(wrong - free_attempts, 8u);
  return std::min(std::chrono::seconds(1u << doublings), LoginGuard::longest_delay);
}

}  // namespace

struct LoginGuard::Tables {
  Table<Attempts> addresses;
  Table<Attempts> pairs; /**< those of known browsers, too */
  Table<Browser> browsers;

  static Attempts& at(Table<Attempts>& table, const std::string& key, SteadyTime now) {
    if (!table.contains(key)) {
      make_room(table, [](const Attempts& each) { return each.underway == 0; });
    }
    Attempts& attempts = table[key];
    if (attempts.underway == 0 && now - attempts.last >= memory) {
      attempts.wrong = 0;
    }
    attempts.last = now;
    return attempts;
  }

  /** The browser's key in `pairs` when it counts as known for that name. */
  [[nodiscard]] std::optional<std::string> known(const Source& source) const {
    const std::string key = source.token.empty() ? "" : sha256_hex(source.token);
    const auto found = browsers.find(key);
    if (found == browsers.end() || found->second.name != source.name) {
      return std::nullopt;
    }
    const auto attempts = pairs.find(key);
    const bool trusted = attempts == pairs.end() || attempts->second.wrong < free_attempts_of_browser;
    return trusted ? std::optional(key) : std::nullopt;
  }
};

LoginGuard::Attempt::Attempt(std::shared_ptr<Tables> tables, std::string address, std::string pair)
    : tables_(std::move(tables)), address_(std::move(address)), pair_(std::move(pair)) {}

LoginGuard::Attempt::~Attempt() {
  if (!tables_) {
    return;
  }
  const auto leave = [&](Table<Attempts>& table, const std::string& key) {
    if (const auto found = table.find(key); found != table.end()) {
      --found->second.underway;
      found->second.wrong -= judged_ || found->second.wrong == 0 ? 0u : 1u;
    }
  };
  leave(tables_->addresses, address_);
  leave(tables_->pairs, pair_);
}

void LoginGuard::Attempt::judged(bool right) {
  if (right) {
    // The address keeps the wrong ones before: whoever has a password of his own could else wipe them out.
    Attempts& pair = tables_->pairs[pair_];
    pair.wrong = static_cast<unsigned>(pair.underway);
  }
  judged_ = !right;
}

LoginGuard::LoginGuard() : tables_(std::make_shared<Tables>()) {}

std::optional<LoginGuard::Attempt> LoginGuard::begin(const Source& source, SteadyTime now) {
  const auto browser = tables_->known(source);
  // Hashed, so that a long name takes no more memory than a short one.
  Attempt attempt(nullptr, browser ? "" : "from " + source.address,
                  browser.value_or(sha256_hex(source.address + ' ' + source.name)));
  Attempts& pair = Tables::at(tables_->pairs, attempt.pair_, now);
  attempt.delay_ = delay_after(pair.wrong, free_attempts_of_pair);
  if (pair.underway >= pair_places) {
    return std::nullopt;
  }
  if (!browser) {
    Attempts& address = Tables::at(tables_->addresses, attempt.address_, now);
    attempt.delay_ = std::max(attempt.delay_, delay_after(address.wrong, free_attempts_of_address));
    if (address.underway >= address_places) {
      return std::nullopt;
    }
    ++address.underway;
    ++address.wrong;
  }
  ++pair.underway;
  ++pair.wrong;
  attempt.tables_ = tables_;
  return attempt;
}

void LoginGuard::know(const std::string& token, const std::string& name, SteadyTime now) {
  make_room(tables_->browsers, [](const Browser&) { return true; });
  tables_->browsers[sha256_hex(token)] = {name, now};
}

}  // namespace interlock
