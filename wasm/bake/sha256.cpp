// SHA-256 (FIPS 180-4) in place of io/file/sha256.cpp, which uses OpenSSL.

#include "io/file/sha256.h"

#include "memory_files.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace domelight {

namespace {

/// The first 32 bits of the fraction of a root of each of the first `count` primes (section 4.2.2).
template <int count, typename Root>
std::array<std::uint32_t, count> fractions(const Root& root) {
    std::array<std::uint32_t, count> bits;
    int found = 0;
    for (int candidate = 2; found < count; ++candidate) {
        bool prime = true;
        for (int divisor = 2; divisor * divisor <= candidate; ++divisor) prime = prime && candidate % divisor;
        if (!prime) continue;
        const double value = root(double(candidate));
        bits[std::size_t(found++)] = std::uint32_t((value - std::floor(value)) * 4294967296.0);
    }
    return bits;
}

}  // namespace

struct Sha256::State {
    std::array<std::uint32_t, 64> constants = fractions<64>([](double prime) { return std::cbrt(prime); });
    std::array<std::uint32_t, 8> hash = fractions<8>([](double prime) { return std::sqrt(prime); });
    std::array<std::uint8_t, 64> block = {};
    std::uint64_t bytes = 0;

    void add(std::uint8_t byte) {
        block[std::size_t(bytes++ % 64)] = byte;
        if (bytes % 64 == 0) process();
    }

    /// Section 6.2.2.
    void process() {
        std::array<std::uint32_t, 64> w;
        for (std::size_t t = 0; t < 16; ++t)
            w[t] = std::uint32_t(block[4 * t]) << 24 | std::uint32_t(block[4 * t + 1]) << 16 | std::uint32_t(block[4 * t + 2]) << 8 | block[4 * t + 3];
        for (std::size_t t = 16; t < 64; ++t) {
            const std::uint32_t s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ w[t - 15] >> 3;
            const std::uint32_t s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ w[t - 2] >> 10;
            w[t] = w[t - 16] + s0 + w[t - 7] + s1;
        }
        auto [a, b, c, d, e, f, g, h] = hash;
        for (std::size_t t = 0; t < 64; ++t) {
            const std::uint32_t t1 = h + (std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25)) + ((e & f) ^ (~e & g)) + constants[t] + w[t];
            const std::uint32_t t2 = (std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22)) + ((a & b) ^ (a & c) ^ (b & c));
            h = g, g = f, f = e, e = d + t1, d = c, c = b, b = a, a = t1 + t2;
        }
        const std::array<std::uint32_t, 8> worked{a, b, c, d, e, f, g, h};
        for (std::size_t k = 0; k < 8; ++k) hash[k] += worked[k];
    }
};

Sha256::Sha256() : state_(std::make_unique<State>()) {}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) state_->add(byte);
}

std::string Sha256::finish() {
    const std::uint64_t bits = 8 * state_->bytes;
    state_->add(0x80);
    while (state_->bytes % 64 != 56) state_->add(0);
    for (int shift = 56; shift >= 0; shift -= 8) state_->add(std::uint8_t(bits >> shift));
    std::string hex;
    for (const std::uint32_t word : state_->hash)
        for (int shift = 28; shift >= 0; shift -= 4) hex += "0123456789abcdef"[word >> shift & 15];
    return hex;
}

Result<std::string> sha256_files(std::span<const std::filesystem::path> files) {
    Sha256 hash;
    for (const auto& file : files) {
        const auto found = memory_files().find(file.string());
        if (found == memory_files().end()) return Error{"is not there", file.string(), ""};
        hash.add(found->second);
    }
    return hash.finish();
}

}  // namespace domelight
