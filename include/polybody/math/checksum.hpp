#pragma once
/// \file
/// Checksum of a text, which detects accidental changes of files.
#include <cstdint>
#include <string_view>

#include <polybody/math/compiler.hpp>

namespace polybody {

/// FNV-1a hash of 64 bits [Fowler, Noll & Vo; draft-eastlake-fnv]: h ← (h xor byte)·p for each byte of `bytes`, with
/// the prime p = 0x100000001b3. A change of any one byte changes the hash. The hash detects accidental changes, not
/// forgery.
constexpr std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t h = 0xcbf29ce484222325u;
  for (char const c : bytes) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return h;
}

}  // namespace polybody
