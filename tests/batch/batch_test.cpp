#include "domelight/batch/batch_plan.h"
#include "domelight/batch/batch_results.h"
#include "domelight/batch/batch_run.h"
#include "domelight/environment/sky/sky.h"
#include "domelight/filtering/kernel/zonal_kernel.h"
#include "domelight/io/write_image.h"

#include "batch/claims.h"
#include "batch/option_reader.h"
#include "batch/thumbnail.h"
#include "test.h"

#include <algorithm>
#include <fstream>
#include <numeric>

using namespace domelight;

namespace {

BatchPlan plan_of(const std::vector<double>& seconds) {
    BatchPlan plan;
    for (std::size_t i = 0; i < seconds.size(); ++i) {
        BatchJob& job = plan.jobs.emplace_back();
        job.output = std::to_string(i);
        job.seconds = seconds[i];
    }
    return plan;
}

double load(const BatchPlan& plan, const std::vector<std::size_t>& shard) {
    double sum = 0;
    for (const std::size_t job : shard) sum += plan.jobs[job].seconds;
    return sum;
}

/// A folder with two small skies, and its plan.
BatchPlan small_plan(const domelight::test::TemporaryFolder& folder) {
    std::filesystem::create_directories(folder / "in");
    for (const char* name : {"in/a.hdr", "in/b.hdr"}) {
        SkyOptions sky;
        sky.height = 8;
        sky.sun_elevation_deg = name[3] == 'a' ? 20 : 60;
        REQUIRE(write_hdr(folder / name, *make_sky(sky)));
    }
    BatchPlanOptions options;
    options.options = {{"size", "8"}, {"irradiance_size", "4"}, {"brdf_size", "8"}, {"preview", "false"}};
    auto plan = plan_batch(folder / "in", options);
    REQUIRE(plan);
    REQUIRE(write_plan(*plan, folder / "batch"));
    return *plan;
}

}  // namespace

TEST_CASE("batch: shards hold each job once, and differ by less than the longest job") {
    std::vector<double> seconds;
    for (int i = 0; i < 1000; ++i) seconds.push_back(0.1 + (i * 7919 % 1000) / 100.0 + (i % 50 == 0 ? 40 : 0));
    const BatchPlan plan = plan_of(seconds);
    for (const int count : {1, 2, 7, 64}) {
        CAPTURE(count);
        const auto shards = plan_shards(plan, count);
        REQUIRE(int(shards.size()) == count);
        std::vector<std::size_t> all;
        double most = 0, least = 1e300;
        for (const auto& shard : shards) {
            all.insert(all.end(), shard.begin(), shard.end());
            most = std::max(most, load(plan, shard));
            least = std::min(least, load(plan, shard));
            CHECK(std::is_sorted(shard.begin(), shard.end(), [&](std::size_t a, std::size_t b) {
                return plan.jobs[a].seconds > plan.jobs[b].seconds;
            }));
        }
        std::sort(all.begin(), all.end());
        std::vector<std::size_t> each(plan.jobs.size());
        std::iota(each.begin(), each.end(), std::size_t(0));
        CHECK(all == each);
        // With a thousand jobs the last ones are short: they even out what the long ones left (Graham 1969).
        CHECK(most - least < 1);
        CHECK(plan_shards(plan, count) == shards);
    }
    CHECK(plan_shards(plan_of({5, 4, 3, 3, 3}), 2) == std::vector<std::vector<std::size_t>>{{0, 3}, {1, 2, 4}});
    CHECK(plan_shards(plan_of({1}), 3)[1].empty());
}

TEST_CASE("batch: a plan that is read is the one that was written") {
    const domelight::test::TemporaryFolder folder;
    const BatchPlan plan = small_plan(folder);
    const auto read = read_plan(folder / "batch");
    REQUIRE(read);
    REQUIRE(read->jobs.size() == 2);
    CHECK(read->root == plan.root);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(read->jobs[i].id == plan.jobs[i].id);
        CHECK(read->jobs[i].options == plan.jobs[i].options);
        CHECK(read->jobs[i].seconds == plan.jobs[i].seconds);
        CHECK(read->jobs[i].memory == plan.jobs[i].memory);
        CHECK(read->jobs[i].inputs[0].sha256 == plan.jobs[i].inputs[0].sha256);
    }
    CHECK(plan.jobs[0].id != plan.jobs[1].id);
}

TEST_CASE("batch: what a scene names is an input of its jobs, and changes them") {
    const domelight::test::TemporaryFolder folder;
    std::filesystem::create_directories(folder / "s/maps");
    SkyOptions sky;
    sky.height = 8;
    REQUIRE(write_hdr(folder / "a.hdr", *make_sky(sky)));
    const auto write = [&](const char* name, const std::string& text) { std::ofstream(folder / name) << text; };
    write("s/room.obj", "mtllib room.mtl\nmtllib not there.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("s/room.mtl", "newmtl wall\nmap_Kd -s 2 2 1 maps/brick.png\nmap_Ke maps/brick.png\n");
    write("s/maps/brick.png", "red");
    write("s/lamp post.bin", "1234");
    write("s/lamp.gltf", R"({"asset": {"version": "2.0"}, "buffers": [{"uri": "lamp%20post.bin"}, {"uri": "data:,"}],
                            "images": [{"uri": "maps/brick.png"}, {"uri": "../a.hdr"}, {"bufferView": 0}]})");
    write("jobs.jsonl", R"({"kind": "render", "environment": "a.hdr", "scene": "s/room.obj", "output": "room"}
{"kind": "render", "environment": "a.hdr", "scene": "s/lamp.gltf", "output": "lamp"}
)");
    const auto planned = [&] {
        auto plan = plan_batch(folder / "jobs.jsonl", {});
        REQUIRE_MESSAGE(plan, plan.error().format());
        return *plan;
    };
    const auto named = [](const BatchJob& job) {
        std::string text;
        for (const BatchInput& input : job.inputs)
            if (input.role == "scene_file") text += input.file + "|";
        return text;
    };
    const BatchPlan before = planned();
    REQUIRE(before.jobs.size() == 2);
    const auto job = [](const BatchPlan& plan, const char* name) {
        return *std::ranges::find_if(plan.jobs, [&](const BatchJob& j) { return j.output.starts_with(name); });
    };
    CHECK(named(job(before, "room")) == "s/room.mtl|s/maps/brick.png|");
    CHECK(named(job(before, "lamp")) == "s/lamp post.bin|s/maps/brick.png|");
    write("s/lamp post.bin", "4321");
    const BatchPlan after = planned();
    CHECK(job(after, "lamp").id != job(before, "lamp").id);
    CHECK(job(after, "room").id == job(before, "room").id);
}

TEST_CASE("batch: a job that is run twice is done once, and a lock keeps another run from it") {
    const domelight::test::TemporaryFolder folder;
    const BatchPlan plan = small_plan(folder);
    const auto first = run_batch_job(plan, folder / "batch", 0, 1),
               second = run_batch_job(plan, folder / "batch", 0, 1);
    REQUIRE(first);
    REQUIRE(second);
    CHECK(first->status == BatchStatus::done);
    CHECK(second->status == BatchStatus::kept);
    {
        auto claims = Claims::open(folder / "batch" / "locks");
        REQUIRE(claims);
        REQUIRE(claims->take(plan.jobs[1].id));
        const auto refused = run_batch_job(plan, folder / "batch", 1, 1);
        REQUIRE(!refused);
        CHECK(refused.error().what == "another run is doing the job");
    }
    CHECK(run_batch_job(plan, folder / "batch", 1, 1));
    CHECK(!run_batch_job(plan, folder / "batch", 2, 1));
    const auto merge = merge_batch(plan, folder / "batch");
    REQUIRE(merge);
    CHECK(merge->complete());
    CHECK(merge->placed == 2);
    CHECK(verify_batch(plan, folder / "batch")->problems.empty());
}

TEST_CASE("batch: options are of their type, in their range, and known") {
    const auto json = Json::parse(R"({"size": 8, "lobe": "ggx", "numbers": [1, "inf"], "for": "three", "zstd": true})");
    REQUIRE(json);
    OptionReader reader(*json);
    std::optional<int> size;
    std::vector<double> numbers;
    std::vector<std::string> engines;
    bool zstd = false;
    Lobe lobe = Lobe::charlie;
    reader.read("size", size);
    reader.read("lobe", lobe);
    reader.read("numbers", numbers);
    reader.read("for", engines);
    CHECK(!reader.finish());  // zstd has not been read
    reader.read("zstd", zstd);
    CHECK(reader.finish());
    CHECK((size == 8 && lobe == Lobe::ggx && numbers.size() == 2 && engines.size() == 1 && zstd));
    OptionReader wrong(*json);
    double value = 0;
    wrong.read("size", value, 10, 20);
    REQUIRE(!wrong.finish());
    CHECK(wrong.finish().error().format() == "`size`: 8 is not from 10 to 20");
}

TEST_CASE("batch: a thumbnail of a constant picture is constant") {
    const domelight::test::TemporaryFolder folder;
    ImageF image(700, 350, 3);
    for (float& v : image.pixels()) v = 0.25f;
    REQUIRE(write_exr(folder / "grey.exr", image.view()));
    const auto small = thumbnail(folder / "grey.exr", 640, 1);
    REQUIRE(small);
    CHECK(small->width() == 350);
    CHECK(std::ranges::all_of(small->pixels(), [&](std::uint8_t v) { return v == small->pixels()[0]; }));
}
