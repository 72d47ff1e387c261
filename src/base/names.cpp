#include "domelight/base/names.h"

#include "base/text.h"

namespace domelight {

Error unknown_name(std::string_view word, std::string_view kind, std::span<const std::string> accepted) {
    std::string list;
    for (const std::string& name : accepted) list += (list.empty() ? "" : ", ") + name;
    return {text("\"", word, "\" is not ", kind), "", text("Accepted: ", list, ".")};
}

}  // namespace domelight
