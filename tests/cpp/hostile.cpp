// Every function of the header with NULL for each pointer and bad numbers for each integer: the documented error, nothing
// changed, nothing written.

#include "check.hpp"
#include "functions.hpp"

#include <fstream>
#include <iterator>
#include <set>

namespace {

// Names before an opening parenthesis, outside of comments.
std::set<std::string> declared_functions() {
    std::ifstream file(WELT_HEADER);
    std::string code{std::istreambuf_iterator<char>(file), {}};
    for (std::size_t start; (start = code.find("/*")) != std::string::npos;)
        code.erase(start, code.find("*/", start) + 2 - start);
    std::set<std::string> names;
    for (std::size_t open = code.find('('); open != std::string::npos; open = code.find('(', open + 1)) {
        std::size_t const start = code.find_last_of(" *\n(", open - 1) + 1;
        std::string const name = code.substr(start, open - start);
        if (name.compare(0, 5, "welt_") == 0) names.insert(name);
    }
    return names;
}

void every_function_is_in_the_table() {
    std::set<std::string> const declared = declared_functions();
    std::set<std::string> tested;
    for (Function const& function : functions()) {
        tested.insert(function.name);
        check::that(function.pointers != "wrong", function.name + ": one character for each pointer");
    }
    check::that(declared.size() > 60, "the header is read");
    for (std::string const& missing : declared)
        check::that(tested.count(missing) == 1, missing + " is not tested: add it to support/functions.cpp");
}

void calls_succeed_as_they_are() {
    for (Function const& function : functions()) {
        World world;
        std::int32_t const status = function.call(world, {});
        check::that(status == WELT_OK, function.name + ": " + welt_error_message(world.out.error));
    }
}

// What a mesh was before the call, and whether a failed call wrote or changed anything.
void nothing_happened(World& world, std::string const& before, std::string const& what) {
    check::that(world.content() == before, what + ": something was changed");
    check::that(!world.has_result(), what + ": a result was written");
}

void null_for_every_pointer() {
    for (Function const& function : functions()) {
        for (int pointer = 0; pointer < int(function.pointers.size()); ++pointer) {
            std::string const what = function.name + ", pointer " + std::to_string(pointer);
            World world;
            std::string before;
            Change change;
            change.null = pointer;
            change.before = [&] { before = world.content(); };
            std::int32_t const status = function.call(world, change);
            if (function.pointers[std::size_t(pointer)] != 'r') {
                check::that(status == WELT_OK, what + " may be NULL: " + welt_error_message(world.out.error));
                continue;
            }
            check::that(status == WELT_ERROR_ARGUMENT, what + " must not be NULL");
            if (function.has_error) {
                std::string const message = welt_error_message(world.out.error);
                check::that(message.find("is NULL") != std::string::npos, what + ": " + message);
            }
            nothing_happened(world, before, what);
        }
    }
}

void bad_numbers() {
    using Value = std::function<std::uint64_t(std::uint64_t, std::uint64_t)>;
    Value const values[] = {
        [](auto, auto) { return 0; },
        [](auto, auto) { return 1; },
        [](auto right, auto) { return right - 1; },
        [](auto, auto largest) { return largest; },
    };
    int failed = 0, succeeded = 0;
    for (Function const& function : functions())
        for (int integer = 0; integer < function.integers; ++integer)
            for (std::size_t value = 0; value < std::size(values); ++value) {
                std::string const what =
                    function.name + ", integer " + std::to_string(integer) + ", value " + std::to_string(value);
                World world;
                std::string before;
                Change change;
                change.integer = integer;
                change.value = values[value];
                change.before = [&] { before = world.content(); };
                std::int32_t const status = function.call(world, change);
                bool const documented = status <= WELT_OK && status >= WELT_ERROR_RULE &&
                                        status != WELT_ERROR_POISONED && status != WELT_ERROR_INTERNAL &&
                                        status != WELT_ERROR_CANCELLED;
                check::that(documented, what + ": status " + std::to_string(status));
                if (status != WELT_OK) nothing_happened(world, before, what);
                ++(status == WELT_OK ? succeeded : failed);
            }
    std::printf("%d calls failed, %d succeeded\n", failed, succeeded);
    check::that(failed > 100 && succeeded > 50, "bad numbers are bad, and some are not");
}

}  // namespace

int main() {
    every_function_is_in_the_table();
    calls_succeed_as_they_are();
    null_for_every_pointer();
    bad_numbers();
    return check::result();
}
