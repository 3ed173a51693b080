// Every function of the header with NULL for each pointer and bad numbers for each integer: the documented error, nothing
// changed, nothing written.

#include "check.hpp"
#include "functions.hpp"

#include <fstream>
#include <iterator>
#include <map>
#include <set>

namespace {

// The names of the parameters that are pointers, from what stands between the parentheses of a declaration.
std::vector<std::string> pointers_of(std::string const& parameters) {
    std::vector<std::string> names;
    int depth = 0;
    std::string parameter;
    for (char c : parameters + ',') {
        depth += (c == '(') - (c == ')');
        if (c != ',' || depth > 0) {
            parameter += c;
            continue;
        }
        // A pointer to a function has its name in parentheses.
        std::size_t end = parameter.find(')');
        if (end == std::string::npos) end = parameter.size();
        std::size_t const start = parameter.find_last_of(" *\n", end - 1) + 1;
        if (parameter.find('*') != std::string::npos) names.push_back(parameter.substr(start, end - start));
        parameter.clear();
    }
    return names;
}

// The functions of the header and their parameters that are pointers.
std::map<std::string, std::vector<std::string>> declared_functions() {
    std::ifstream file(WELT_HEADER);
    std::string code{std::istreambuf_iterator<char>(file), {}};
    for (std::size_t start; (start = code.find("/*")) != std::string::npos;)
        code.erase(start, code.find("*/", start) + 2 - start);
    std::map<std::string, std::vector<std::string>> functions;
    for (std::size_t open = code.find('('); open != std::string::npos; open = code.find('(', open + 1)) {
        std::size_t const start = code.find_last_of(" *\n(", open - 1) + 1;
        std::string const name = code.substr(start, open - start);
        if (name.compare(0, 5, "welt_") == 0)
            functions[name] = pointers_of(code.substr(open + 1, code.find(");", open) - open - 1));
    }
    return functions;
}

void every_function_is_in_the_table() {
    auto const declared = declared_functions();
    std::set<std::string> tested;
    for (Function const& function : functions()) {
        tested.insert(function.name);
        check::that(function.pointers != "wrong", function.name + ": one character for each pointer");
    }
    check::that(declared.size() > 60, "the header is read");
    for (auto const& [name, pointers] : declared)
        check::that(tested.count(name) == 1, name + " is not tested: add it to support/functions.cpp");
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
    auto const declared = declared_functions();
    int named = 0;
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
                std::string const name = declared.at(function.name).at(std::size_t(pointer));
                check::that(message == name + " is NULL", what + ", which is " + name + ": " + message);
                ++named;
            }
            nothing_happened(world, before, what);
        }
    }
    check::that(named > 80, "messages name parameters");
}

void no_handle_no_answer() {
    check::that(welt_error_code(nullptr) == WELT_OK && !*welt_error_message(nullptr), "no error");
    check::that(welt_error_place_count(nullptr) == 0 && welt_error_place_kind(nullptr, 0) == WELT_PLACE_WHOLE &&
                    welt_error_place_id(nullptr, 0, 0) == WELT_NONE && !*welt_error_place_message(nullptr, 0) &&
                    !*welt_error_place_file(nullptr, 0) && welt_error_place_line(nullptr, 0) == 0 &&
                    welt_error_place_column(nullptr, 0) == 0,
                "no places");
    check::that(welt_job_progress(nullptr) == 0 && welt_job_stage(nullptr, nullptr, 0) == 0, "no job");
    check::that(!*welt_report_json(nullptr) && welt_selection_count(nullptr) == 0 && welt_patches_count(nullptr) == 0,
                "no report, no selection, no patches");
    check::that(welt_mesh_vertex_count(nullptr) == 0 && welt_mesh_edge_count(nullptr) == 0 &&
                    welt_mesh_face_count(nullptr) == 0 && welt_mesh_face_vertex_count(nullptr) == 0,
                "no mesh");
    check::that(welt_refinement_vertex_count(nullptr, 0) == 0 && welt_refinement_edge_count(nullptr, 0) == 0 &&
                    welt_refinement_face_count(nullptr, 0) == 0 && welt_refinement_face_vertex_count(nullptr, 0) == 0,
                "no refinement");
    check::that(welt_rules_parameter_count(nullptr) == 0 && !*welt_rules_parameter_name(nullptr, 0) &&
                    !*welt_rules_parameter_unit(nullptr, 0) && !*welt_rules_parameter_help(nullptr, 0) &&
                    welt_rules_parameter_default(nullptr, 0) == 0,
                "no rules");
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
                bool const documented = status <= WELT_OK && status >= WELT_ERROR_MEMORY &&
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
    no_handle_no_answer();
    bad_numbers();
    return check::result();
}
