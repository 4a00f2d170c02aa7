// Reads the environments of a scene file: their pictures, and how these are turned.
#pragma once

#include <photongrid/io/image_file.hpp>
#include <photongrid/io/surface_reader.hpp>

namespace photongrid {

/// A scene file's values, and those that make a mesh or an environment.
class environment_reader : public surface_reader {
public:
    using surface_reader::surface_reader;

    /// The map and the rotation of an environment.
    void read_environment(const json_value& v, environment_light& l) const
    {
        if (const auto* file = v.find("file")) {
            l.file = file_name(*file);
            l.map = map_in(l.file, *file);
        }
        if (const auto* rotate = v.find("rotate")) {
            const auto turn = turn_in(*rotate);
            l.axis = turn.axis;
            l.degrees = turn.degrees;
        }
    }

private:
    std::shared_ptr<const environment_map> map_in(const std::string& name, const json_value& v) const
    {
        try {
            auto picture = read_linear_image(path_of(name));
            environment_map map{picture.width, picture.height, std::move(picture.pixels)};
            check(map);
            return std::make_shared<const environment_map>(std::move(map));
        } catch (const file_error& e) {
            fail(v.place, e.what());
        } catch (const std::invalid_argument& e) {
            fail(v.place, path_of(name) + ": " + std::string(e.what()).substr(5)); // without "map: "
        }
    }
};

} // namespace photongrid
