// Control cages against the refinements of them that were made in Blender and shipped (folder cc_pairs).

#include "check.hpp"
#include "models.hpp"
#include "points.hpp"

int main() {
    std::string const data = data_folder();
    if (data.empty()) return skipped;
    struct Pair {
        char const* name;
        unsigned level;
    };
    // The cages were recovered from the shipped files, which are written with few digits: this is the catalogue's
    // residual (2.5e-6, rounded) of the size.
    double const residual = 2.6e-6;
    for (Pair const& pair : {Pair{"bs0_slippers", 1}, Pair{"bsby_fork", 2}, Pair{"kl_coffee-mug", 1}, Pair{"sc_jar", 1},
                             Pair{"sc_tubular_chair", 1}}) {
        std::string const path = data + "/cc_pairs/" + pair.name;
        Polygons const cage = read_obj(path + "_L0.obj");
        Polygons const shipped = read_obj(path + "_L" + std::to_string(pair.level) + ".obj");
        Level const level = refine(make_mesh(cage), pair.level)[pair.level];
        check::that(level.positions.size() == shipped.positions.size(), std::string(pair.name) + ": other vertex count");
        check::that(level.parent_faces.size() == shipped.sizes.size(), std::string(pair.name) + ": other face count");
        double const size = size_of(shipped.positions);
        double const off = set_distance(level.positions, shipped.positions, 1e-4 * size) / size;
        std::printf("%-20s off by %.1e of the size\n", pair.name, off);
        check::that(off <= residual, std::string(pair.name) + " is off");
    }
    return check::result();
}
