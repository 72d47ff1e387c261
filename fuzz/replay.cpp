// Runs a fuzz target's LLVMFuzzerTestOneInput without a fuzzer: over files, and over seeded mutations of each. Built
// with the sanitizers, this is the part of fuzzing that a test run can afford. The same arguments give the same inputs
// on every machine.
//
//     hdr_fuzz [--runs N] [--seed N] [--slow SECONDS] FILE-OR-FOLDER...
//
// A crash leaves the input that caused it as ./crash-NAME, and no closing line.

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
// Present where the sanitizers are linked: called before they end the program.
extern "C" void __sanitizer_set_death_callback(void (*callback)()) __attribute__((weak));

namespace {

using Bytes = std::vector<std::uint8_t>;

std::string g_target;
Bytes g_input;

/// Keeps the input that brings the program down. Only plain system calls: the heap may be broken.
void keep_input() {
    char name[256];
    std::snprintf(name, sizeof name, "crash-%s", g_target.c_str());
    if (std::FILE* file = std::fopen(name, "wb")) {
        std::fwrite(g_input.data(), 1, g_input.size(), file);
        std::fclose(file);
        std::fprintf(stderr, "the input is kept in %s\n", name);
    }
}

/// splitmix64 (Steele, Lea and Flood 2014): the same sequence everywhere, unlike the standard library's distributions.
class Random {
  public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    /// In [0, n); 0 for n = 0.
    std::size_t below(std::size_t n) { return n ? next() % n : 0; }
    /// Half the time in the first bytes, where headers are.
    std::size_t place(std::size_t size) { return below(next() & 1 ? std::min<std::size_t>(size, 512) : size); }

  private:
    std::uint64_t state_;
};

/// Values that break size arithmetic.
constexpr std::uint64_t k_odd_numbers[] = {
    0,          1,          0x7f,       0x80,       0xff,       0x7fff,     0xffff, 0x10000,
    0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff, 0x40000000, 0x3fffffff, 100000, 0x7fffffffffffffff};

/// One small change of `bytes`; `other` is an input to borrow pieces from.
void mutate(Bytes& bytes, const Bytes& other, Random& random) {
    const std::size_t size = bytes.size();
    switch (random.below(8)) {
        case 0:
            if (size) bytes[random.place(size)] ^= std::uint8_t(1u << random.below(8));
            return;
        case 1:
            if (size) bytes[random.place(size)] = std::uint8_t(random.next());
            return;
        case 2:
            bytes.resize(random.below(size + 1));
            return;
        case 3: {  // an odd number in place of 1, 2, 4 or 8 bytes, little-endian as in every binary format here
            const std::uint64_t value = k_odd_numbers[random.below(std::size(k_odd_numbers))];
            const std::size_t width = std::size_t(1) << random.below(4), at = random.place(size);
            if (size && at + width <= size) std::memcpy(bytes.data() + at, &value, width);
            return;
        }
        case 4: {  // the head of one input and the tail of another
            const std::size_t cut = random.below(size + 1), from = random.below(other.size() + 1);
            bytes.resize(cut);
            bytes.insert(bytes.end(), other.begin() + std::ptrdiff_t(from), other.end());
            return;
        }
        case 5: {  // a piece copied over another place
            if (!size || other.empty()) return;
            const std::size_t from = random.below(other.size()), at = random.place(size);
            const std::size_t count = std::min({1 + random.below(64), other.size() - from, size - at});
            std::copy_n(other.begin() + std::ptrdiff_t(from), count, bytes.begin() + std::ptrdiff_t(at));
            return;
        }
        case 6: {  // a piece taken out
            const std::size_t at = random.place(size), count = std::min(1 + random.below(64), size - at);
            bytes.erase(bytes.begin() + std::ptrdiff_t(at), bytes.begin() + std::ptrdiff_t(at + count));
            return;
        }
        default: {  // a digit changed: text headers hold their sizes in decimal
            const std::size_t at = random.place(size);
            for (std::size_t i = at; i < std::min(size, at + 256); ++i) {
                if (bytes[i] < '0' || bytes[i] > '9') continue;
                bytes[i] = std::uint8_t('0' + random.below(10));
                return;
            }
        }
    }
}

double seconds_of(const Bytes& input) {
    const auto start = std::chrono::steady_clock::now();
    LLVMFuzzerTestOneInput(input.data(), input.size());
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<std::filesystem::path> files_under(const std::vector<std::string>& places) {
    std::vector<std::filesystem::path> files;
    for (const std::string& place : places) {
        if (!std::filesystem::is_directory(place)) {
            files.emplace_back(place);
            continue;
        }
        for (const auto& entry : std::filesystem::recursive_directory_iterator(place))
            if (entry.is_regular_file()) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

int main(int argc, char** argv) {
    g_target = std::filesystem::path(argv[0]).filename().string();
    std::size_t runs = 0;
    std::uint64_t seed = 1;
    double slow = 2;
    std::vector<std::string> places;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        const char* value = i + 1 < argc ? argv[i + 1] : "";
        if (argument == "--runs")
            runs = std::strtoul(value, nullptr, 10), ++i;
        else if (argument == "--seed")
            seed = std::strtoull(value, nullptr, 10), ++i;
        else if (argument == "--slow")
            slow = std::atof(value), ++i;
        else
            places.push_back(argument);
    }
    if (__sanitizer_set_death_callback) __sanitizer_set_death_callback(keep_input);

    std::vector<Bytes> inputs(1);  // the empty input first
    std::vector<std::string> names{"nothing"};
    for (const auto& file : files_under(places)) {
        std::ifstream in(file, std::ios::binary);
        if (!in) {
            std::fprintf(stderr, "error: %s: cannot be read\n", file.c_str());
            return 1;
        }
        inputs.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
        names.push_back(file.filename().string());
    }

    // About `runs` in all, however many files there are.
    const int mutations = int(runs / inputs.size());
    long ran = 0, too_slow = 0;
    double slowest = 0;
    const auto run = [&](Bytes input, const std::string& name, int mutation) {
        g_input = std::move(input);
        const double seconds = seconds_of(g_input);
        ++ran;
        slowest = std::max(slowest, seconds);
        if (seconds <= slow) return;
        ++too_slow;
        std::printf("slow: %.1f s for %s, mutation %d of seed %llu\n", seconds, name.c_str(), mutation,
                    (unsigned long long)seed);
    };
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        run(inputs[i], names[i], 0);
        for (int mutation = 1; mutation <= mutations; ++mutation) {
            // Each input's mutations depend on the seed, its place and nothing else.
            Random random(seed * 1000003 + i * 4099 + std::uint64_t(mutation));
            const Bytes& other = inputs[random.below(inputs.size())];
            Bytes changed = inputs[i];
            for (std::size_t n = 1 + random.below(4); n > 0; --n) mutate(changed, other, random);
            run(std::move(changed), names[i], mutation);
        }
    }
    std::printf("%zu inputs, slowest %.2f s\n", inputs.size(), slowest);
    std::printf("%s: %ld passed, %ld failed, 0 skipped\n", g_target.c_str(), ran - too_slow, too_slow);
    return too_slow ? 1 : 0;
}
