#include "scene/gltf/gltf_meshopt.h"

#include <fmt/format.h>
#include <meshoptimizer.h>

namespace domelight {

namespace {

/// The largest number of elements that so many packed bytes can hold. The library checks this too, but only after the
/// output is allocated.
std::uint64_t most_elements(const GltfMeshopt& m, std::size_t packed) {
    // Vertices: a header byte represents at most four groups of 16 bytes. Triangles and indices: at least one byte
    // each.
    if (m.mode == "ATTRIBUTES") return 64 * std::uint64_t(packed) / m.stride;
    return m.mode == "TRIANGLES" ? 3 * std::uint64_t(packed) : std::uint64_t(packed);
}

Result<void> check(const GltfMeshopt& m, std::size_t packed) {
    const bool attributes = m.mode == "ATTRIBUTES";
    if (!attributes && m.mode != "TRIANGLES" && m.mode != "INDICES") return Error{"meshopt: no such mode", "", ""};
    if (attributes ? m.stride == 0 || m.stride > 256 || m.stride % 4 : m.stride != 2 && m.stride != 4)
        return Error{fmt::format("meshopt: a stride of {} bytes", m.stride), "", ""};
    if (m.mode == "TRIANGLES" && m.count % 3)
        return Error{"meshopt: the number of indices is not a multiple of 3", "", ""};
    if (!attributes && m.filter != "NONE") return Error{"meshopt: indices with a filter", "", ""};
    if (m.filter == "OCTAHEDRAL" ? m.stride != 4 && m.stride != 8 : m.filter == "QUATERNION" && m.stride != 8)
        return Error{fmt::format("meshopt: filter with a stride of {} bytes", m.stride), "", ""};
    if (m.filter != "NONE" && m.filter != "OCTAHEDRAL" && m.filter != "QUATERNION" && m.filter != "EXPONENTIAL")
        return Error{"meshopt: no such filter", "", ""};
    if (m.count > most_elements(m, packed))
        return Error{fmt::format("meshopt: {} bytes cannot hold {} elements", packed, m.count), "", ""};
    return {};
}

}  // namespace

Result<std::vector<std::uint8_t>> unpack_meshopt(const GltfMeshopt& m, std::span<const std::uint8_t> packed,
                                                 ByteBudget& budget) {
    if (const auto checked = check(m, packed.size()); !checked) return checked.error();
    if (const auto room = budget.take(m.count, m.stride, "unpacking"); !room) return room.error();
    std::vector<std::uint8_t> out(m.count * m.stride);
    if (out.empty()) return out;
    const int failed = m.mode == "ATTRIBUTES"
                           ? meshopt_decodeVertexBuffer(out.data(), m.count, m.stride, packed.data(), packed.size())
                       : m.mode == "TRIANGLES"
                           ? meshopt_decodeIndexBuffer(out.data(), m.count, m.stride, packed.data(), packed.size())
                           : meshopt_decodeIndexSequence(out.data(), m.count, m.stride, packed.data(), packed.size());
    if (failed) return Error{"meshopt: the packed data is broken", "", ""};
    if (m.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(out.data(), m.count, m.stride);
    if (m.filter == "QUATERNION") meshopt_decodeFilterQuat(out.data(), m.count, m.stride);
    if (m.filter == "EXPONENTIAL") meshopt_decodeFilterExp(out.data(), m.count, m.stride);
    return out;
}

}  // namespace domelight
