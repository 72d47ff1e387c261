#pragma once

#include "domelight/bake/bake.h"

#include <chrono>
#include <optional>
#include <vector>

namespace domelight::cli {

class Stopwatch {
  public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The result for one environment.
struct BakeOutcome {
    std::vector<std::string> environment;
    std::filesystem::path folder;
    bool up_to_date = false;
    std::optional<Error> error;
    BakeReport report;
    double seconds = 0;
};

/// A few lines on stdout: the files, and how long the bake took.
void print_summary(const BakeOutcome& outcome);

/// The document of bake --json:
/// {"version", "bakes": [{"environment": [..], "folder", "status": "baked" | "up to date" | "failed", "error",
/// "seconds", "band_limit",
///  "negative_texels_set_to_0", "warnings": [..], "stages": [{"stage", "seconds", "cpu_seconds"}],
///  "engines": [{"engine", "folder", "manifest": {..}}]}]}
void print_json(const std::vector<BakeOutcome>& outcomes);

}  // namespace domelight::cli
