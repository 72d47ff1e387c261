#include "io/file/sha256.h"

#include "io/file/byte_source.h"
#include "io/file/path_inside.h"

#include <openssl/evp.h>

#include <algorithm>
#include <vector>

namespace domelight {

struct Sha256::State {
    EVP_MD_CTX* context = EVP_MD_CTX_new();
    State() { EVP_DigestInit_ex(context, EVP_sha256(), nullptr); }
    ~State() { EVP_MD_CTX_free(context); }
};

Sha256::Sha256() : state_(std::make_unique<State>()) {}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;

void Sha256::add(std::span<const std::uint8_t> bytes) {
    EVP_DigestUpdate(state_->context, bytes.data(), bytes.size());
}

std::string Sha256::finish() {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned int length = 0;
    EVP_DigestFinal_ex(state_->context, digest, &length);
    std::string hex;
    for (unsigned int i = 0; i < length; ++i) {
        hex += "0123456789abcdef"[digest[i] >> 4];
        hex += "0123456789abcdef"[digest[i] & 15];
    }
    return hex;
}

Result<std::string> sha256_files(std::span<const std::filesystem::path> files) {
    Sha256 hash;
    std::vector<std::uint8_t> buffer(std::size_t(1) << 20);
    for (const auto& file : files) {
        auto source = FileSource::open(file);
        if (!source) return source.error();
        for (std::uint64_t at = 0; at < source->size(); at += buffer.size()) {
            const auto piece = std::span(buffer).first(std::min<std::uint64_t>(buffer.size(), source->size() - at));
            if (auto ok = source->read(at, piece, "content"); !ok) return ok.error().at(file.string());
            hash.add(piece);
        }
    }
    return hash.finish();
}

Result<std::string> sha256_in_folder(const std::filesystem::path& folder, const std::string& name) {
    const auto file = path_inside(folder / name, folder, name);
    if (!file) return file.error();
    return sha256_file(*file);
}

}  // namespace domelight
