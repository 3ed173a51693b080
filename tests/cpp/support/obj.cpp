#include "obj.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

Polygons read_obj(std::string const& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error(path + " cannot be read");
    Polygons polygons;
    std::string line, word;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        words >> word;
        if (line.rfind("v ", 0) == 0) {
            Vector p;
            words >> p.x >> p.y >> p.z;
            polygons.positions.push_back(p);
        } else if (line.rfind("f ", 0) == 0) {
            std::uint32_t size = 0;
            while (words >> word) {
                long long number = std::stoll(word);
                long long count = static_cast<long long>(polygons.positions.size());
                polygons.vertices.push_back(static_cast<std::uint32_t>(number < 0 ? count + number : number - 1));
                ++size;
            }
            polygons.sizes.push_back(size);
        }
    }
    return polygons;
}
