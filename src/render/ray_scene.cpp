#include "render/ray_scene.h"

#include "domelight/base/large_allocator.h"
#include "domelight/base/parallel.h"

#include "scene/sound_places.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <new>

namespace domelight {
namespace {

bool count_bytes(void* sum, ssize_t bytes, bool) {
    *static_cast<std::atomic<std::int64_t>*>(sum) += bytes;
    return true;
}

/// The triangles of one mesh, with positions transformed by `place`.
template <typename Place>
RTCGeometry make_triangles(RTCDevice device, const Mesh& mesh, const Place& place) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, mesh.positions.size()));
    auto* indices = static_cast<std::uint32_t*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, mesh.indices.size() / 3));
    if (vertices)
        for (const Vec3f& p : mesh.positions) {
            const Vec3f w = place(p);
            *vertices++ = w.x, *vertices++ = w.y, *vertices++ = w.z;
        }
    if (indices) std::copy(mesh.indices.begin(), mesh.indices.end(), indices);
    rtcCommitGeometry(geometry);
    return geometry;
}

}  // namespace

RayScene::Impl::~Impl() {
    if (world) rtcReleaseScene(world);
    for (RTCScene object : objects)
        if (object) rtcReleaseScene(object);
    if (device) rtcReleaseDevice(device);
}

RayScene::RayScene() : impl_(std::make_unique<Impl>()) {}
RayScene::~RayScene() = default;
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
const Scene& RayScene::scene() const {
    return impl_->scene;
}
std::size_t RayScene::memory_bytes() const {
    return impl_->bytes;
}

namespace {

/// Whether there is room for the stacks of Embree's workers. They are oneTBB's, which ends the program where a thread
/// cannot be started, so this is asked before.
bool room_for_workers() {
    const std::size_t bytes = (std::size_t(32) + std::size_t(8) * std::size_t(resolve_threads(0))) << 20;
    try {
        free_large(allocate_large(bytes), bytes);
        return true;
    } catch (const std::bad_alloc&) {
        return false;
    }
}

}  // namespace

Result<RayScene> RayScene::build(Scene scene) {
    RayScene out;
    Impl& impl = *out.impl_;
    impl.scene = std::move(scene);
    const Scene& s = impl.scene;
    if (s.triangle_count() == 0) return Error{"the scene has no triangles", "", ""};
    const Error no_memory{"out of memory for the scene's acceleration structure", "", ""};
    if (!room_for_workers()) return no_memory;
    // Embree's own worker threads are oneTBB's; "threads=1" would pin all of TBB to one core.
    impl.device = rtcNewDevice(nullptr);
    if (!impl.device) return Error{"Embree cannot start", "", ""};
    std::atomic<std::int64_t> bytes{0};
    rtcSetDeviceMemoryMonitorFunction(impl.device, count_bytes, &bytes);
    impl.world = rtcNewScene(impl.device);
    rtcSetSceneBuildQuality(impl.world, RTC_BUILD_QUALITY_HIGH);

    std::vector<int> uses(s.meshes.size());
    for (const Instance& i : s.instances) ++uses[i.mesh];
    impl.objects.resize(s.meshes.size());
    for (int i = 0; i < int(s.instances.size()); ++i) {
        const Instance& instance = s.instances[i];
        const Mesh& mesh = s.meshes[instance.mesh];
        if (mesh.indices.empty()) continue;
        RTCGeometry geometry;
        if (uses[instance.mesh] == 1 || !has_sound_inverse(instance.to_world)) {
            // A mesh that stands once goes into the world itself: one level less to walk. So does one that is flattened
            // there: no ray can be turned into its frame.
            geometry = make_triangles(impl.device, mesh, [&](const Vec3f& p) { return instance.to_world.point(p); });
        } else {
            RTCScene& object = impl.objects[instance.mesh];
            if (!object) {
                object = rtcNewScene(impl.device);
                rtcSetSceneBuildQuality(object, RTC_BUILD_QUALITY_HIGH);
                RTCGeometry triangles = make_triangles(impl.device, mesh, [](const Vec3f& p) { return p; });
                rtcAttachGeometry(object, triangles);
                rtcReleaseGeometry(triangles);
                rtcCommitScene(object);
            }
            geometry = rtcNewGeometry(impl.device, RTC_GEOMETRY_TYPE_INSTANCE);
            rtcSetGeometryInstancedScene(geometry, object);
            const Affine& m = instance.to_world;
            const float columns[12] = {m.x.x, m.x.y, m.x.z, m.y.x,           m.y.y,           m.y.z,
                                       m.z.x, m.z.y, m.z.z, m.translation.x, m.translation.y, m.translation.z};
            rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
            rtcCommitGeometry(geometry);
        }
        const unsigned id = rtcAttachGeometry(impl.world, geometry);
        rtcReleaseGeometry(geometry);
        if (id >= impl.instance_of.size()) impl.instance_of.resize(id + 1, -1);
        impl.instance_of[id] = i;
    }
    if (!room_for_workers()) return no_memory;
    rtcCommitScene(impl.world);
    rtcSetDeviceMemoryMonitorFunction(impl.device, nullptr, nullptr);
    impl.emitters = Emitters(s);
    impl.bytes = std::size_t(std::max<std::int64_t>(0, bytes));
    if (const RTCError error = rtcGetDeviceError(impl.device); error != RTC_ERROR_NONE)
        return error == RTC_ERROR_OUT_OF_MEMORY ? no_memory
                                                : Error{fmt::format("Embree reports error {}", int(error)), "", ""};
    return out;
}

Hit RayScene::Impl::hit_of(unsigned geometry, unsigned instance_id, unsigned triangle, float distance, float u, float v,
                           const Vec3f& Ng) const {
    if (geometry == RTC_INVALID_GEOMETRY_ID) return {};
    const bool instanced = instance_id != RTC_INVALID_GEOMETRY_ID;
    const int instance = instance_of[instanced ? instance_id : geometry];
    const Affine& m = scene.instances[instance].to_world;
    Vec3f normal = instanced ? m.normal(Ng) : Ng;
    // A mirroring transform reverses the orientation of triangles (for corners as for cofactors), but glTF's front
    // stays the front.
    if (m.determinant() < 0) normal = -normal;
    return {distance, instance, int(triangle), u, v, normal};
}

namespace {

/// Embree ends the program at a ray that is not finite. Such a ray meets nothing.
bool traceable(const Ray& ray) {
    constexpr float k_most = 1e18f;
    const auto finite = [](const Vec3f& v) {
        return std::abs(v.x) < k_most && std::abs(v.y) < k_most && std::abs(v.z) < k_most;
    };
    return finite(ray.origin) && finite(ray.direction) && ray.near >= 0;
}

}  // namespace

Hit RayScene::Impl::intersect(const Ray& ray, bool coherent) const {
    if (!traceable(ray)) return {};
    RTCRayHit r;
    r.ray.org_x = ray.origin.x, r.ray.org_y = ray.origin.y, r.ray.org_z = ray.origin.z;
    r.ray.dir_x = ray.direction.x, r.ray.dir_y = ray.direction.y, r.ray.dir_z = ray.direction.z;
    r.ray.tnear = ray.near;
    r.ray.tfar = ray.far;
    r.ray.time = 0;
    r.ray.mask = ~0u;
    r.ray.flags = 0;
    r.hit.geomID = r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    rtcIntersect1(world, &context, &r);
    return hit_of(r.hit.geomID, r.hit.instID[0], r.hit.primID, r.ray.tfar, r.hit.u, r.hit.v,
                  {r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z});
}

bool RayScene::Impl::occluded(const Ray& ray) const {
    if (!traceable(ray)) return false;
    RTCRay r;
    r.org_x = ray.origin.x, r.org_y = ray.origin.y, r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x, r.dir_y = ray.direction.y, r.dir_z = ray.direction.z;
    r.tnear = ray.near;
    r.tfar = ray.far;
    r.time = 0;
    r.mask = ~0u;
    r.flags = 0;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(world, &context, &r);
    return r.tfar < 0;
}

namespace {

/// Embree's layout of a packet; lanes past the last ray, and of rays that cannot be traced, are switched off.
void fill(RTCRay16& r, int (&valid)[16], std::span<const Ray* const> rays) {
    for (int i = 0; i < 16; ++i) {
        const Ray& ray = *rays[std::min<std::size_t>(std::size_t(i), rays.size() - 1)];
        valid[i] = i < int(rays.size()) && traceable(ray) ? -1 : 0;
        r.org_x[i] = ray.origin.x, r.org_y[i] = ray.origin.y, r.org_z[i] = ray.origin.z;
        r.dir_x[i] = ray.direction.x, r.dir_y[i] = ray.direction.y, r.dir_z[i] = ray.direction.z;
        r.tnear[i] = ray.near;
        r.tfar[i] = ray.far;
        r.time[i] = 0;
        r.mask[i] = ~0u;
        r.flags[i] = 0;
    }
}

}  // namespace

void RayScene::Impl::intersect(std::span<const Ray* const> rays, std::span<Hit> hits) const {
    alignas(64) RTCRayHit16 r;
    alignas(64) int valid[16];
    fill(r.ray, valid, rays);
    for (int i = 0; i < 16; ++i) r.hit.geomID[i] = r.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect16(valid, world, &context, &r);
    for (std::size_t i = 0; i < rays.size(); ++i)
        hits[i] = hit_of(r.hit.geomID[i], r.hit.instID[0][i], r.hit.primID[i], r.ray.tfar[i], r.hit.u[i], r.hit.v[i],
                         {r.hit.Ng_x[i], r.hit.Ng_y[i], r.hit.Ng_z[i]});
}

std::uint32_t RayScene::Impl::occluded(std::span<const Ray* const> rays) const {
    alignas(64) RTCRay16 r;
    alignas(64) int valid[16];
    fill(r, valid, rays);
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded16(valid, world, &context, &r);
    std::uint32_t hidden = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) hidden |= std::uint32_t(r.tfar[i] < 0) << i;
    return hidden;
}

}  // namespace domelight
