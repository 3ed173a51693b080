#include "obj.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace {

void read_tag(std::istringstream& words, Tags& tags) {
    std::string name;
    int ints = 0, floats = 0, strings = 0;
    char slash = 0;
    words >> name >> ints >> slash >> floats >> slash >> strings;
    std::vector<std::uint32_t> numbers(ints);
    std::vector<float> values(floats);
    std::string method;
    for (auto& number : numbers) words >> number;
    for (float& value : values) words >> value;
    if (strings > 0) words >> method;
    auto const value = [&](std::size_t i) { return values.size() > i ? values[i] : values.at(0); };
    if (name == "crease") {
        for (std::size_t i = 0; i + 1 < numbers.size(); ++i) {
            tags.crease_vertices.insert(tags.crease_vertices.end(), {numbers[i], numbers[i + 1]});
            tags.crease_sharpness.push_back(value(i));
        }
    } else if (name == "corner") {
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            tags.corner_vertices.push_back(numbers[i]);
            tags.corner_sharpness.push_back(value(i));
        }
    } else if (name == "hole") {
        tags.holes.insert(tags.holes.end(), numbers.begin(), numbers.end());
    } else if (name == "interpolateboundary") {
        tags.boundary = static_cast<int>(numbers.at(0));
    } else if (name == "creasemethod") {
        tags.chaikin = method == "chaikin";
    }
}

}  // namespace

bool operator==(Tags const& a, Tags const& b) {
    auto const all = [](Tags const& tags) {
        return std::tie(tags.crease_vertices, tags.crease_sharpness, tags.corner_vertices, tags.corner_sharpness,
                        tags.holes, tags.boundary, tags.chaikin);
    };
    return all(a) == all(b);
}

Polygons read_obj(std::string const& path, bool with_tags) {
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
        } else if (with_tags && line.rfind("t ", 0) == 0) {
            read_tag(words, polygons.tags);
        }
    }
    return polygons;
}
