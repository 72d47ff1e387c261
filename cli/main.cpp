#include <fmt/core.h>

int main() {
    fmt::print("domelight {}\n", DOMELIGHT_VERSION);
    return 0;
}
