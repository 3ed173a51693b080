// Puts a groove across the edges you name, tells how far it is, and writes the new control mesh.
//
//   c++ -std=c++17 groove.cpp -lwelt -o groove
//   ./groove chair.obj seam.obj ring:3,331 "width=1.6 depth=0.6"
#include <welt.hpp>

#include <cstdio>

int main(int count, char** arguments) {
    if (count != 5) {
        std::fprintf(stderr, "usage: groove IN.obj OUT.obj MARKS SETTINGS\n");
        return 2;
    }
    try {
        welt::Mesh mesh = welt::Mesh::import_file(arguments[1]);
        welt::Selection const marks = mesh.select(arguments[3]);
        welt::Job const job([](double progress, std::string_view stage) {
            std::fprintf(stderr, "%3.0f %% %.*s\n", 100 * progress, int(stage.size()), stage.data());
        });
        welt::Report const report = mesh.apply(marks, "groove", arguments[4], {}, &job);
        mesh.export_file(arguments[2]);
        std::printf("%zu edges marked; the mesh now has %zu vertices\n", marks.count(), mesh.vertex_count());
        std::printf("%s\n", report.json().data());
    } catch (welt::Error const& error) {
        std::fprintf(stderr, "%s\n", error.what());
        for (welt::Place const& place : error.places())
            std::fprintf(stderr, "  %s:%u:%u: %s\n", place.file.c_str(), unsigned(place.line), unsigned(place.column),
                         place.message.c_str());
        return 1;
    }
}
