// The models the tests run over.
#pragma once

#include "obj.hpp"
#include "library.hpp"

#include <functional>
#include <string>
#include <vector>

// Exit code of a test that was skipped.
constexpr int skipped = 77;

// Path of a file or folder among the models; empty, with a message, where the models are absent.
std::string data_folder();

// Calls `test` for every control cage in osd (tags ignored), upholstery, product, organic and classic that is a
// manifold; with `with_tags` once more for those in osd whose file has tags, with them. The others are printed with the reason; a file that is refused without being known as a non-manifold,
// or accepted in spite of it, is a failure. Returns the exit code.
using CageTest = std::function<void(std::string const& name, Polygons const&, Mesh const&)>;
int for_each_cage(CageTest const& test, bool with_tags = false);
