#pragma once

#include "io/file/byte_budget.h"
#include "io/file/file_reader.h"
#include "scene/gltf/gltf_document.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace domelight {

/// The bytes behind a glTF document: buffers, views (unpacked where EXT_meshopt_compression packed them) and the
/// numbers of accessors. Nothing is allocated before the bytes that fill it are known to exist.
class GltfData {
  public:
    /// `chunk`: the binary chunk of a .glb. `folder`: where uris are looked up; they may not leave it. Empty: only
    /// data uris are resolved.
    /// Errors: a buffer that is missing or shorter than claimed.
    static Result<GltfData> open(const GltfDocument& document, std::span<const std::uint8_t> chunk,
                                 const std::optional<std::filesystem::path>& folder, ByteBudget& budget);

    /// The bytes of a view. Errors: it does not lie in its buffer; packed data is broken.
    Result<std::span<const std::uint8_t>> view(int view);

    const GltfAccessor& accessor(int a) const { return document_->accessors[std::size_t(a)]; }

    /// Checks that all elements of the accessor exist, with so many components, before memory is allocated for them.
    Result<void> check(int accessor, int components);

    /// Elements [first, first + count) of an accessor as floats, normalised where the accessor says so: count x
    /// components values to `out`. Errors: the accessor has another number of components, or does not lie in its view.
    Result<void> read(int accessor, std::uint64_t first, std::uint64_t count, int components, float* out);

    /// All of a scalar accessor of unsigned integers.
    Result<std::vector<std::uint32_t>> read_indices(int accessor);

    /// The bytes that a uri of the file stands for: data, or a file in its folder.
    Result<std::shared_ptr<const FileBytes>> resource(const std::string& uri);

  private:
    GltfData(const GltfDocument& document, std::optional<std::filesystem::path> folder, ByteBudget& budget)
        : document_(&document), folder_(std::move(folder)), budget_(&budget) {}
    Result<std::span<const std::uint8_t>> range(int buffer, std::uint64_t offset, std::uint64_t length) const;
    Result<std::span<const std::uint8_t>> elements(int view, std::uint64_t offset, std::uint64_t count,
                                                   std::size_t bytes, std::uint64_t& stride, const std::string& what);
    Result<void> apply_sparse(int accessor, std::uint64_t first, std::uint64_t count, float* out);

    const GltfDocument* document_;
    std::optional<std::filesystem::path> folder_;
    ByteBudget* budget_;
    std::vector<std::span<const std::uint8_t>> buffers_;
    std::vector<std::shared_ptr<const FileBytes>> held_;
    std::vector<std::vector<std::uint8_t>> unpacked_;  // by view; empty: not yet, or not packed
    std::uint64_t bytes_given_ = 0;                    // by all buffers
};

}  // namespace domelight
