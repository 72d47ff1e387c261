#include "sampling.h"

#include "domelight/base/parallel.h"
#include "domelight/sampling/environment_sampler.h"
#include "domelight/sampling/sequences.h"

#include "base/field_place.h"
#include "environment.h"
#include "keywords.h"
#include "work.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace domelight::python {
namespace {

/// As many numbers of each of these; samples are drawn in pieces of so many.
constexpr int k_piece = 8192;
/// u, v, x, y, z, r, g, b and the density: the rows of the array that samples are written to.
constexpr std::size_t k_rows = 9;

EnvironmentSampler build(const Environment& environment, const nb::dict& dictionary) {
    const Keywords words(dictionary);
    EnvironmentSamplerOptions options;
    words.read("method", options.method);
    words.read("weight", options.weight);
    words.read("compensate", options.compensate);
    words.read("uniform_share", options.uniform_share);
    words.read("threads", options.threads);
    if (!(options.uniform_share >= 0 && options.uniform_share <= 1))
        throw Failure({fmt::format("{:g} is not from 0 to 1", options.uniform_share), field_place("uniform_share"), ""});
    return run_work_for(nb::none(), [&](const Progress&) {
        return value_of(EnvironmentSampler::build(environment, options));
    });
}

using FloatRows = nb::ndarray<float, nb::c_contig, nb::device::cpu, nb::ndim<2>>;

/// Nine rows of numbers, and those of one piece of the samples.
class SampleRows {
  public:
    SampleRows(float* data, std::size_t count) : data_(data), count_(count) {}
    LightSampleSpans piece(std::size_t begin, std::size_t end) const {
        const auto row = [&](std::size_t r) { return std::span<float>(data_ + r * count_ + begin, end - begin); };
        return {row(0), row(1), row(2), row(3), row(4), row(5), row(6), row(7), row(8)};
    }

  private:
    float* data_;
    std::size_t count_;
};

/// The array that samples are written to, which must be float32 of shape (9, count).
SampleRows rows_of(const nb::object& out, std::size_t count) {
    FloatRows rows;
    if (!nb::try_cast(out, rows, false) || rows.shape(0) != k_rows || rows.shape(1) != count)
        throw Failure({fmt::format("expected a writable, contiguous array of float32 of shape (9, {})", count),
                       field_place("out"), "numpy.empty((9, n), numpy.float32) is one."});
    return {rows.data(), count};
}

/// Calls a function for pieces of many samples, without the interpreter's lock.
void for_pieces(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& function) {
    if (count <= std::size_t(k_piece)) {
        const nb::gil_scoped_release release;
        return function(0, count);
    }
    run_work(nb::none(), [&](const Progress&) {
        parallel_ranges(int(count), k_piece, threads, [&](int begin, int end) {
            function(std::size_t(begin), std::size_t(end));
        });
    });
}

void check_count(std::size_t count, const char* keyword) {
    if (count > std::size_t(1) << 30)
        throw Failure({fmt::format("{} are too many at once: at most 2^30", count), field_place(keyword), ""});
}

/// Points of the unit square as an array holds them: uint32 in 32-bit fixed point, or numbers from 0 to below 1.
class Points {
  public:
    explicit Points(nb::handle array) {
        using Code = nb::dlpack::dtype_code;
        const bool shaped = nb::try_cast(array, array_, false) && array_.ndim() == 2 && array_.shape(1) == 2;
        if (!shaped)
            throw Failure({"expected an array of shape (count, 2)", field_place("points"),
                           "Each row is a point of the unit square."});
        const auto type = array_.dtype();
        fixed_ = Code(type.code) == Code::UInt && type.bits == 32;
        wide_ = Code(type.code) == Code::Float && type.bits == 64;
        if (!fixed_ && !wide_ && !(Code(type.code) == Code::Float && type.bits == 32))
            throw Failure({"expected points of float32, float64 (0 to below 1) or uint32 (times 2^-32)",
                           field_place("points"), ""});
        if (array_.size() > 0 && !array_.data()) throw Failure({"the array's memory has been freed", field_place("points"), ""});
        check_count(array_.shape(0), "points");
    }
    std::size_t count() const { return array_.shape(0); }

    /// Points begin .. end - 1: in place where they are fixed-point numbers, else in `room`.
    std::span<const UnitPoint> piece(std::size_t begin, std::size_t end, std::vector<UnitPoint>& room) const {
        const std::int64_t row = array_.stride(0), column = array_.stride(1);
        if (fixed_ && column == 1 && row == 2)
            return {static_cast<const UnitPoint*>(array_.data()) + begin, end - begin};
        room.resize(end - begin);
        if (fixed_)
            convert<std::uint32_t>(begin, room, row, column);
        else if (wide_)
            convert<double>(begin, room, row, column);
        else
            convert<float>(begin, room, row, column);
        return room;
    }

  private:
    static std::uint32_t fixed(std::uint32_t value) { return value; }
    static std::uint32_t fixed(double value) { return unit_fixed(value); }
    template <typename T>
    void convert(std::size_t begin, std::span<UnitPoint> out, std::int64_t row, std::int64_t column) const {
        const T* from = static_cast<const T*>(array_.data()) + std::int64_t(begin) * row;
        for (UnitPoint& point : out) {
            point = {fixed(from[0]), fixed(from[column])};
            from += row;
        }
    }
    nb::ndarray<nb::ro, nb::device::cpu> array_;
    bool fixed_ = false, wide_ = false;
};

/// Draws at given points.
void sample_points(const EnvironmentSampler& sampler, nb::handle array, const nb::object& out, int threads) {
    const Points points(array);
    const SampleRows rows = rows_of(out, points.count());
    for_pieces(points.count(), threads, [&](std::size_t begin, std::size_t end) {
        std::vector<UnitPoint> room;
        sampler.sample(points.piece(begin, end, room), rows.piece(begin, end));
    });
}

PointSet point_set(const nb::dict& dictionary, std::size_t count) {
    const Keywords words(dictionary);
    PointSet points;
    points.sequence = Sequence::sobol;
    words.read("sequence", points.sequence);
    words.read("seed", points.seed);
    points.count = int(count);
    return points;
}

/// Draws at the points of a sequence.
void sample_sequence(const EnvironmentSampler& sampler, std::size_t count, const nb::dict& dictionary,
                     const nb::object& out, int threads) {
    check_count(count, "n");
    const PointSet points = point_set(dictionary, count);
    const SampleRows rows = rows_of(out, count);
    for_pieces(count, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<UnitPoint> drawn(end - begin);
        for (std::size_t i = begin; i < end; ++i) drawn[i - begin] = points[int(i)];
        sampler.sample(drawn, rows.piece(begin, end));
    });
}

/// u, v, radiance and density of directions; `out` as of sample_points().
void look_up(const EnvironmentSampler& sampler, nb::handle array, const nb::object& out, int threads) {
    const ArrayPixels directions = ArrayPixels::borrow(array, 3, "directions");
    const std::size_t count = std::size_t(directions.height()) * std::size_t(directions.width());
    const SampleRows rows = rows_of(out, count);
    const int width = directions.width();
    {
        const nb::gil_scoped_release release;
        std::vector<float> row(3 * std::size_t(width));
        for (int y = 0; y < directions.height(); ++y) {
            directions.copy_rows(y, {row.data(), width, 1, 3});
            const LightSampleSpans to = rows.piece(std::size_t(y) * std::size_t(width), std::size_t(y + 1) * std::size_t(width));
            for (std::size_t i = 0; i < std::size_t(width); ++i)
                to.x[i] = row[3 * i], to.y[i] = row[3 * i + 1], to.z[i] = row[3 * i + 2];
        }
    }
    const LightSampleSpans all = rows.piece(0, count);
    for (std::size_t i = 0; i < count; ++i) {
        const float squared = all.x[i] * all.x[i] + all.y[i] * all.y[i] + all.z[i] * all.z[i];
        if (!(squared > 0 && squared <= 3.4e38f))
            throw Failure({fmt::format("direction {} is ({:g}, {:g}, {:g}), which points nowhere", i, all.x[i], all.y[i],
                                       all.z[i]),
                           field_place("directions"), ""});
    }
    for_pieces(count, threads, [&](std::size_t begin, std::size_t end) { sampler.look_up(rows.piece(begin, end)); });
}

/// The points of a sequence as uint32 of shape (count, 2).
nb::object unit_points(std::size_t count, const nb::dict& dictionary) {
    check_count(count, "n");
    const PointSet points = point_set(dictionary, count);
    auto drawn = std::make_unique<std::vector<UnitPoint>>(count);
    for (std::size_t i = 0; i < count; ++i) (*drawn)[i] = points[int(i)];
    void* const data = drawn->data();
    nb::capsule owner(drawn.release(), [](void* p) noexcept { delete static_cast<std::vector<UnitPoint>*>(p); });
    const std::size_t shape[2] = {count, 2};
    return nb::cast(nb::ndarray<nb::numpy, std::uint32_t>(data, 2, shape, owner));
}

/// An uninitialised array of float32 of shape (9, count), in large pages.
nb::object sample_room(std::size_t count) {
    check_count(count, "n");
    return numpy_of(ImageF::uninitialized(int(count), int(k_rows), 1), {k_rows, count});
}

}  // namespace

void declare_sampling(nb::module_& module) {
    nb::class_<EnvironmentSampler>(module, "EnvironmentSampler")
        .def_prop_ro("compensation", &EnvironmentSampler::compensation)
        .def_prop_ro("memory_bytes", &EnvironmentSampler::memory_bytes)
        .def_prop_ro("size", [](const EnvironmentSampler& s) { return nb::make_tuple(s.image().height, s.image().width); })
        .def("sample_points", &sample_points, nb::arg("points"), nb::arg("out"), nb::arg("threads"))
        .def("sample_sequence", &sample_sequence, nb::arg("n"), nb::arg("options"), nb::arg("out"), nb::arg("threads"))
        .def("look_up", &look_up, nb::arg("directions"), nb::arg("out"), nb::arg("threads"));
    module.def("build_sampler", &build, nb::arg("environment"), nb::arg("options"));
    module.def("unit_points", &unit_points, nb::arg("n"), nb::arg("options"));
    module.def("sample_room", &sample_room, nb::arg("n"));
}

}  // namespace domelight::python
