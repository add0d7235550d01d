/**
 * @file
 * The checksum of OpenIGTLink: CRC-64 of ECMA-182, not reflected, from 0, without a final XOR.
 */
#pragma once

#include "igtl/wire.hpp"

namespace interlock::igtl {

/** 0 for no bytes and for zeros of any number: it says nothing about such a body. */
std::uint64_t crc64(Bytes bytes) noexcept;

}  // namespace interlock::igtl
