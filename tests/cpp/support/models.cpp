#include "models.hpp"

#include "check.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

namespace fs = std::filesystem;

namespace {

// By the catalogue of the models: edges with three faces, faces that name a vertex twice, fans that meet in a vertex,
// neighbours that are inside out to each other.
std::set<std::string> const non_manifold = {
    "osd/catmark_fan.obj", "osd/catmark_nonman_edge100.obj", "osd/catmark_nonman_edges.obj", "osd/catmark_nonman_quadpole360.obj",
    "osd/catmark_nonman_quadpole8.obj", "osd/loop_nonman_edge100.obj", "osd/loop_nonman_edges.obj",
    "osd/loop_val2_interior.obj", "product/bs0_flacon_cage.obj", "product/kl_spray-bottle_cage.obj",
    "product/q_car_sports.obj", "organic/bs0_horse2.obj", "organic/q_stegosaurus.obj",
};

}  // namespace

std::string data_folder() {
    if (fs::is_directory(WELT_DATA)) return WELT_DATA;
    std::printf("skipped: %s is absent\n", WELT_DATA);
    return "";
}

int for_each_cage(CageTest const& test, bool with_tags) {
    std::string const data = data_folder();
    if (data.empty()) return skipped;
    std::vector<std::string> names;
    for (char const* folder : {"osd", "upholstery", "product", "organic", "classic"}) {
        for (auto const& entry : fs::directory_iterator(fs::path(data) / folder)) {
            if (entry.path().extension() == ".obj") {
                names.push_back(folder + ("/" + entry.path().filename().string()));
            }
        }
    }
    std::sort(names.begin(), names.end());
    int tested = 0, tested_with_tags = 0;
    for (std::string const& name : names) {
        Polygons const polygons = read_obj(data + "/" + name);
        try {
            Mesh const mesh = make_mesh(polygons);
            check::that(non_manifold.count(name) == 0, name + " is accepted, though it is no manifold");
            test(name, polygons, mesh);
            ++tested;
            Polygons const tagged = read_obj(data + "/" + name, with_tags);
            if (tagged.tags == polygons.tags) continue;
            test(name + " with tags", tagged, make_mesh(tagged));
            ++tested_with_tags;
        } catch (welt::Error const& refused) {
            if (refused.code() != WELT_ERROR_MESH) throw;
            std::printf("%s left out: %s\n", name.c_str(), refused.what());
            check::that(non_manifold.count(name) == 1, name + " is refused: " + refused.what());
        }
    }
    std::printf("%d of %zu models tested\n", tested, names.size());
    check::that(tested > 100, "too few models");
    if (with_tags) {
        std::printf("%d models tested with tags\n", tested_with_tags);
        check::that(tested_with_tags > 25, "too few models with tags");
    }
    return check::result();
}
