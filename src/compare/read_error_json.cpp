#include "compare/read_error_json.h"

namespace domelight {
namespace {

Json reads_json(const std::vector<ReadErrorAt>& reads) {
    Json json = Json::array();
    for (const ReadErrorAt& at : reads)
        json.push_back({{"roughness", at.roughness},
                        {"level", at.level},
                        {"relative_rmse", at.relative_rmse},
                        {"largest", at.largest}});
    return json;
}

}  // namespace

Json read_errors_json(const ReadErrors& errors) {
    return {{"relative_rmse", errors.relative_rmse},
            {"largest", errors.largest},
            {"levels", reads_json(errors.levels)},
            {"between", reads_json(errors.between)}};
}

}  // namespace domelight
