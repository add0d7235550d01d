/**
 * @file
 * What can be wrong with a message of OpenIGTLink, before anybody asks what it wants.
 */
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace interlock::igtl {

/** Every reason for which a message is refused. */
enum class Fault : std::uint8_t {
  version,         /**< of the header: neither 1 nor 2 */
  type_name,       /**< empty, not printable, or with something after its end */
  device_name,     /**< not printable, or with something after its end */
  too_large,       /**< beyond the ceiling of its type */
  unknown_type,    /**< of which this app knows nothing; it is skipped */
  wrong_size,      /**< not a size that its type can have */
  checksum,        /**< the CRC is another one */
  extended_header, /**< of version 2: shorter than 12 bytes, or longer than the body */
  metadata,        /**< of version 2: lengths that do not add up */
  inner_length,    /**< a length or dimension inside of the body does not fit the body */
  not_finite,      /**< a number is infinite or none */
  text,            /**< a text is unterminated, has an unknown encoding, or characters that cannot be shown */
  element_type,    /**< an array of something else than floating-point numbers */
  late             /**< it began and did not end in time */
};

/** A fault, and where in the body it is. */
struct FaultAt {
  Fault fault;
  std::string place; /**< for people: "row 3, column 2"; empty: nowhere in particular */

  FaultAt(Fault what, std::string where = "") : fault(what), place(std::move(where)) {}
  operator Fault() const noexcept { return fault; }
};

/** For people: what is wrong, and what was expected. */
std::string_view fault_text(Fault fault) noexcept;

/** Codes of STATUS. */
enum class StatusCode : std::uint16_t {
  invalid = 0,
  ok = 1,
  unknown_error = 2,
  not_found = 4,
  access_denied = 5,
  busy = 6,
  timeout = 7,
  unreachable = 8,
  checksum = 9,
  configuration = 10,
  unknown_instruction = 12,
  not_ready = 13,
  unknown_version = 17,
  hardware_failure = 18
};

/** What a peer is told. */
StatusCode status_of(Fault fault) noexcept;

}  // namespace interlock::igtl
