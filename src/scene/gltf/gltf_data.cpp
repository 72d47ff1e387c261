#include "scene/gltf/gltf_data.h"

#include "io/file/printable.h"
#include "io/image_reader.h"
#include "scene/gltf/gltf_meshopt.h"
#include "scene/gltf/gltf_uri.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace domelight {

namespace {

/// One integer or float as glTF turns it into a float: normalised integers by glTF 2.0, section 3.11 (the same as
/// OpenGL's).
template <typename T>
float to_float(const std::uint8_t* at, bool normalized) {
    T value;
    std::memcpy(&value, at, sizeof value);
    if constexpr (std::is_same_v<T, float>) {
        return value;
    } else {
        if (!normalized) return float(value);
        const float scaled = float(value) / float(std::numeric_limits<T>::max());
        return std::is_signed_v<T> ? std::max(scaled, -1.0f) : scaled;
    }
}

template <typename T>
void convert(const std::uint8_t* in, std::uint64_t stride, std::uint64_t count, int components, bool normalized,
             float* out) {
    if (std::is_same_v<T, float> && stride == std::size_t(components) * sizeof(float)) {
        if (count) std::memcpy(out, in, count * stride);
        return;
    }
    for (std::uint64_t i = 0; i < count; ++i, in += stride)
        for (int c = 0; c < components; ++c) *out++ = to_float<T>(in + std::size_t(c) * sizeof(T), normalized);
}

void convert(int component, const std::uint8_t* in, std::uint64_t stride, std::uint64_t count, int components,
             bool normalized, float* out) {
    switch (component) {
        case gltf_i8:
            return convert<std::int8_t>(in, stride, count, components, normalized, out);
        case gltf_u8:
            return convert<std::uint8_t>(in, stride, count, components, normalized, out);
        case gltf_i16:
            return convert<std::int16_t>(in, stride, count, components, normalized, out);
        case gltf_u16:
            return convert<std::uint16_t>(in, stride, count, components, normalized, out);
        case gltf_u32:
            return convert<std::uint32_t>(in, stride, count, components, normalized, out);
        default:
            return convert<float>(in, stride, count, components, normalized, out);
    }
}

std::uint32_t index_at(int component, const std::uint8_t* at) {
    if (component == gltf_u8) return *at;
    if (component == gltf_u16) return std::uint32_t(at[0] | at[1] << 8);
    std::uint32_t value;
    std::memcpy(&value, at, 4);
    return value;
}

bool index_component(int component) {
    return component == gltf_u8 || component == gltf_u16 || component == gltf_u32;
}

}  // namespace

Result<std::shared_ptr<const FileBytes>> GltfData::resource(const std::string& uri) {
    if (is_data_uri(uri)) {
        Result<std::vector<std::uint8_t>> bytes = decode_data_uri(uri);
        if (!bytes) return bytes.error();
        return FileBytes::from_memory(std::move(*bytes));
    }
    if (!folder_)
        return Error{fmt::format("names the file {}, but is itself in memory", printable(uri, 80)), "",
                     "Give the path of the glTF file, or one that contains its pictures."};
    const auto path = path_of_uri(uri, *folder_);
    if (!path) return path.error();
    auto file = FileBytes::open(*path, budget_->left(), FileKinds::regular);
    if (!file) return Error{printable(uri, 80) + ": " + file.error().what, "", file.error().hint};
    return file;
}

Result<GltfData> GltfData::open(const GltfDocument& document, std::span<const std::uint8_t> chunk,
                                const std::optional<std::filesystem::path>& folder, ByteBudget& budget) {
    GltfData data(document, folder, budget);
    for (std::size_t b = 0; b < document.buffers.size(); ++b) {
        const GltfBuffer& buffer = document.buffers[b];
        std::span<const std::uint8_t> bytes;
        if (!buffer.uri.empty()) {
            auto file = data.resource(buffer.uri);
            if (!file) return Error{fmt::format("buffers[{}]: {}", b, file.error().what), "", file.error().hint};
            bytes = (*file)->bytes();
            data.held_.push_back(std::move(*file));
        } else if (b == 0) {
            bytes = chunk;
        }
        // A buffer without data belongs to packed views; reading it directly is an error.
        if (!bytes.empty() && bytes.size() < buffer.length)
            return Error{fmt::format("buffers[{}]: {} bytes, but byteLength is {}", b, bytes.size(), buffer.length), "",
                         "The file is truncated, or its header is wrong."};
        data.buffers_.push_back(bytes.first(std::min<std::uint64_t>(bytes.size(), buffer.length)));
        data.bytes_given_ += data.buffers_.back().size();
    }
    data.unpacked_.resize(document.views.size());
    return data;
}

Result<std::span<const std::uint8_t>> GltfData::range(int buffer, std::uint64_t offset, std::uint64_t length) const {
    const std::span<const std::uint8_t> bytes = buffers_[std::size_t(buffer)];
    if (offset > bytes.size() || length > bytes.size() - offset)
        return Error{fmt::format("bytes {} to {} of buffer {} do not exist: it has {}", offset, offset + length, buffer,
                                 bytes.size()),
                     "", ""};
    return bytes.subspan(offset, length);
}

Result<std::span<const std::uint8_t>> GltfData::view(int index) {
    const GltfView& view = document_->views[std::size_t(index)];
    const auto named = [&](const Error& e) {
        return Error{fmt::format("bufferViews[{}]: {}", index, e.what), "", e.hint};
    };
    if (!view.meshopt) {
        auto bytes = range(view.buffer, view.offset, view.length);
        return bytes ? bytes : named(bytes.error());
    }
    std::vector<std::uint8_t>& unpacked = unpacked_[std::size_t(index)];
    if (unpacked.empty()) {
        const auto packed = range(view.meshopt->buffer, view.meshopt->offset, view.meshopt->length);
        if (!packed) return named(packed.error());
        auto bytes = unpack_meshopt(*view.meshopt, *packed, *budget_);
        if (!bytes) return named(bytes.error());
        unpacked = std::move(*bytes);
    }
    return std::span<const std::uint8_t>(unpacked).first(std::min<std::uint64_t>(unpacked.size(), view.length));
}

/// The bytes from `offset` of a view, where `count` elements of `bytes` each are known to lie `stride` apart.
Result<std::span<const std::uint8_t>> GltfData::elements(int index, std::uint64_t offset, std::uint64_t count,
                                                         std::size_t bytes, std::uint64_t& stride,
                                                         const std::string& what) {
    const auto whole = view(index);
    if (!whole) return whole.error();
    if (stride == 0) stride = bytes;
    if (stride < bytes)
        return Error{fmt::format("{}: elements of {} bytes lie {} bytes apart", what, bytes, stride), "", ""};
    const std::uint64_t size = whole->size();
    if (count && (offset > size || bytes > size - offset || (count - 1) > (size - offset - bytes) / stride))
        return Error{
            fmt::format("{}: {} elements do not fit into the {} bytes of buffer view {}", what, count, size, index), "",
            ""};
    return count ? whole->subspan(offset) : *whole;
}

Result<void> GltfData::check(int index, int components) {
    const GltfAccessor& a = accessor(index);
    const std::string name = fmt::format("accessors[{}]", index);
    if (a.components != components)
        return Error{fmt::format("{}: elements have not {} components", name, components), "", ""};
    // Zeros that are not stored in the file: no file needs more of them than it has bytes of other data.
    if (a.view < 0)
        return a.count <= bytes_given_ ? Result<void>()
                                       : Error{fmt::format("{}: {} elements of no data", name, a.count), "", ""};
    std::uint64_t stride = document_->views[std::size_t(a.view)].stride;
    const auto from =
        elements(a.view, a.offset, a.count, gltf_component_bytes(a.component) * std::size_t(components), stride, name);
    return from ? Result<void>() : from.error();
}

Result<void> GltfData::read(int index, std::uint64_t first, std::uint64_t count, int components, float* out) {
    if (const auto checked = check(index, components); !checked) return checked.error();
    const GltfAccessor& a = accessor(index);
    if (first > a.count || count > a.count - first)
        return Error{fmt::format("accessors[{}]: {} elements where {} are needed", index, a.count, first + count), "",
                     ""};
    if (a.view >= 0) {
        const std::size_t bytes = gltf_component_bytes(a.component) * std::size_t(components);
        std::uint64_t stride = document_->views[std::size_t(a.view)].stride;
        const auto from = elements(a.view, a.offset, a.count, bytes, stride, "");
        if (!from) return from.error();
        if (count) convert(a.component, from->data() + first * stride, stride, count, components, a.normalized, out);
    } else {
        std::fill_n(out, count * std::uint64_t(components), 0.0f);
    }
    return a.sparse ? apply_sparse(index, first, count, out) : Result<void>();
}

Result<void> GltfData::apply_sparse(int index, std::uint64_t first, std::uint64_t count, float* out) {
    const GltfAccessor& a = accessor(index);
    const GltfAccessor::Sparse& s = *a.sparse;
    const std::string name = fmt::format("accessors[{}].sparse", index);
    if (!index_component(s.index_component)) return Error{name + ": indices of a wrong type", "", ""};
    std::uint64_t index_stride = 0, stride = 0;
    const auto places =
        elements(s.index_view, s.index_offset, s.count, gltf_component_bytes(s.index_component), index_stride, name);
    if (!places) return places.error();
    const std::size_t bytes = gltf_component_bytes(a.component) * std::size_t(a.components);
    const auto values = elements(s.value_view, s.value_offset, s.count, bytes, stride, name);
    if (!values) return values.error();
    for (std::uint64_t i = 0; i < s.count; ++i) {
        const std::uint64_t place = index_at(s.index_component, places->data() + i * index_stride);
        if (place >= a.count) return Error{fmt::format("{}: there is no element {}", name, place), "", ""};
        if (place < first || place >= first + count) continue;
        convert(a.component, values->data() + i * stride, stride, 1, a.components, a.normalized,
                out + (place - first) * std::uint64_t(a.components));
    }
    return {};
}

Result<std::vector<std::uint32_t>> GltfData::read_indices(int index) {
    const GltfAccessor& a = accessor(index);
    const std::string name = fmt::format("accessors[{}]", index);
    if (a.components != 1 || !index_component(a.component))
        return Error{name + ": indices are not scalars of an unsigned type", "", ""};
    if (a.view < 0 || a.sparse) return Error{name + ": indices without a buffer view, or sparse ones", "", ""};
    std::uint64_t stride = document_->views[std::size_t(a.view)].stride;
    const auto from = elements(a.view, a.offset, a.count, gltf_component_bytes(a.component), stride, name);
    if (!from) return from.error();
    if (const auto room = budget_->take(a.count, 4, name); !room) return room.error();
    std::vector<std::uint32_t> indices(a.count);
    if (a.component == gltf_u32 && stride == 4) {
        if (a.count) std::memcpy(indices.data(), from->data(), a.count * 4);
    } else {
        for (std::uint64_t i = 0; i < a.count; ++i) indices[i] = index_at(a.component, from->data() + i * stride);
    }
    return indices;
}

}  // namespace domelight
