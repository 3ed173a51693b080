// A check that prints what failed and lets the program go on.
#pragma once

#include <cstdio>
#include <string>

namespace check {

inline int failures = 0;

// Counts and prints a failure; only the first ones, lest one defect hide the others.
inline void that(bool holds, std::string const& what) {
    if (holds) return;
    if (++failures <= 50) std::printf("FAILED: %s\n", what.c_str());
}

// A small number for a message.
inline std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2e", value);
    return text;
}

// The exit code of the program.
inline int result() {
    std::printf("%d failures\n", failures);
    return failures == 0 ? 0 : 1;
}

}  // namespace check
