// Loading a million triangles with normals and texture coordinates from .glb, .ply and .obj; and the time and memory
// from the file to a scene in which rays can be traced.

#include "domelight/render/render.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace domelight;

namespace {

constexpr int k_side = 707;  // 2 * 707^2 = 999 698 triangles

/// A wavy sphere without poles.
struct Wavy {
    std::vector<float> positions, normals, texcoords;
    std::vector<std::uint32_t> indices;
    Wavy() {
        for (int j = 0; j <= k_side; ++j)
            for (int i = 0; i <= k_side; ++i) {
                const double t = k_pi * (j + 0.5) / (k_side + 1), p = 2 * k_pi * i / k_side;
                const double n[3] = {std::sin(t) * std::sin(p), std::cos(t), std::sin(t) * std::cos(p)};
                const double r = 1 + 0.1 * std::sin(20 * t) * std::sin(20 * p);
                for (const double c : n) positions.push_back(float(c * r)), normals.push_back(float(c));
                texcoords.push_back(float(i) / k_side), texcoords.push_back(float(j) / k_side);
            }
        for (std::uint32_t j = 0; j < k_side; ++j)
            for (std::uint32_t i = 0; i < k_side; ++i) {
                const std::uint32_t a = j * (k_side + 1) + i, b = a + k_side + 1;
                for (const std::uint32_t index : {a, b + 1, a + 1, a, b, b + 1}) indices.push_back(index);
            }
    }
};

template <typename T>
void put(std::string& out, const std::vector<T>& values) {
    out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

std::string glb(const Wavy& w) {
    std::string data;
    put(data, w.positions), put(data, w.normals), put(data, w.texcoords), put(data, w.indices);
    const std::size_t p = w.positions.size() * 4, t = w.texcoords.size() * 4, vertices = w.positions.size() / 3;
    const auto view = [](std::size_t offset, std::size_t length) {
        return fmt::format(R"({{"buffer":0,"byteOffset":{},"byteLength":{}}})", offset, length);
    };
    const auto accessor = [](int number, int component, std::size_t count, const char* type) {
        return fmt::format(R"({{"bufferView":{},"componentType":{},"count":{},"type":"{}"}})", number, component, count,
                           type);
    };
    std::string json = fmt::format(
        R"({{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":{}}}],"bufferViews":[{},{},{},{}],"accessors":[{},{},{},{}],)"
        R"("meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2}},"indices":3}}]}}],"nodes":[{{"mesh":0}}]}})",
        data.size(), view(0, p), view(p, p), view(2 * p, t), view(2 * p + t, w.indices.size() * 4),
        accessor(0, 5126, vertices, "VEC3"), accessor(1, 5126, vertices, "VEC3"), accessor(2, 5126, vertices, "VEC2"),
        accessor(3, 5125, w.indices.size(), "SCALAR"));
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string file = "glTF";
    const auto numbers = [&](std::vector<std::uint32_t> values) { put(file, values); };
    numbers({2, std::uint32_t(28 + json.size() + data.size()), std::uint32_t(json.size()), 0x4e4f534a});
    file += json;
    numbers({std::uint32_t(data.size()), 0x004e4942});
    return file + data;
}

std::string ply(const Wavy& w) {
    std::string file = fmt::format(
        "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
        "z\nproperty float nx\n"
        "property float ny\nproperty float nz\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
        w.positions.size() / 3, w.indices.size() / 3);
    for (std::size_t v = 0; v < w.positions.size(); v += 3)
        for (const auto* values : {&w.positions, &w.normals})
            file.append(reinterpret_cast<const char*>(values->data() + v), 12);
    for (std::size_t t = 0; t < w.indices.size(); t += 3)
        file.append("\3").append(reinterpret_cast<const char*>(w.indices.data() + t), 12);
    return file;
}

std::string obj(const Wavy& w) {
    std::string file;
    for (std::size_t v = 0; v < w.positions.size(); v += 3)
        file += fmt::format("v {:.6f} {:.6f} {:.6f}\nvn {:.4f} {:.4f} {:.4f}\n", w.positions[v], w.positions[v + 1],
                            w.positions[v + 2], w.normals[v], w.normals[v + 1], w.normals[v + 2]);
    for (std::size_t t = 0; t < w.indices.size(); t += 3)
        file +=
            fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", w.indices[t] + 1, w.indices[t + 1] + 1, w.indices[t + 2] + 1);
    return file;
}

void load(benchmark::State& state, std::string (*make)(const Wavy&), const char* name) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / fmt::format("domelight-bench-{}-{}", std::rand(), name);
    {
        static const Wavy wavy;
        const std::string bytes = make(wavy);
        std::ofstream(file, std::ios::binary) << bytes;
        state.counters["file_MB"] = double(bytes.size()) / 1e6;
    }
    std::int64_t triangles = 0;
    for (auto _ : state) {
        const auto scene = load_scene(file);
        if (!scene)
            state.SkipWithError(scene.error().format().c_str());
        else
            triangles = scene->triangle_count();
    }
    state.counters["triangles"] = double(triangles);
    std::filesystem::remove(file);
}

/// The largest memory of the process so far, in bytes.
double most_memory() {
    rusage used;
    getrusage(RUSAGE_SELF, &used);
    return 1024.0 * double(used.ru_maxrss);
}

/// All cores, by the wall clock, because Embree builds on threads of its own.
void load_and_build(benchmark::State& state) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / fmt::format("domelight-bench-{}.glb", std::rand());
    {
        const std::string bytes = glb(Wavy());
        std::ofstream(file, std::ios::binary) << bytes;
    }
    for (auto _ : state) {
        auto scene = load_scene(file);
        if (!scene) return state.SkipWithError(scene.error().format().c_str());
        const auto built = RayScene::build(std::move(*scene));
        if (!built) return state.SkipWithError(built.error().format().c_str());
        state.counters["acceleration_MB"] = double(built->memory_bytes()) / 1e6;
    }
    state.counters["process_MB"] = most_memory() / 1e6;
    std::filesystem::remove(file);
}

BENCHMARK(load_and_build)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
BENCHMARK_CAPTURE(load, glb, glb, "a.glb")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(load, ply, ply, "a.ply")->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(load, obj, obj, "a.obj")->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
