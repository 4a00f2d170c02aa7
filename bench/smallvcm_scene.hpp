// Reads a scene that bench/peer_scenes.py wrote into SmallVCM's own classes; bench/peers.sh has SmallVCM's scene.hxx
// include this. $PHOTONGRID_SCENE names the file.
#pragma once

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>

inline float photongrid_setting(const char* name, float usual)
{
    const char* given = std::getenv(name);
    return given ? static_cast<float>(std::atof(given)) : usual;
}

/// Whether there is a file to read. A template, because it is included before `Scene` and what it holds are known.
template <class Scene, class Size>
bool read_photongrid_scene(Scene& scene, const Size& size)
{
    const char* path = std::getenv("PHOTONGRID_SCENE");
    if (!path)
        return false;
    std::ifstream in(path);
    const auto vector = [&in] {
        float x = 0, y = 0, z = 0;
        in >> x >> y >> z;
        return Vec3f(x, y, z);
    };
    auto* shapes = new GeometryList;
    scene.mGeometry = shapes;
    std::string kind;
    int lamps = 0;
    while (in >> kind) {
        if (kind == "camera") {
            const Vec3f position = vector(), forward = vector(), up = vector();
            float angle = 0;
            in >> angle;
            scene.mCamera.Setup(position, forward, up, Vec2f(float(size.x), float(size.y)), angle);
        } else if (kind == "material") {
            Material m;
            m.mDiffuseReflectance = vector();
            m.mMirrorReflectance = vector();
            in >> m.mIOR;
            scene.mMaterials.push_back(m);
        } else if (kind == "triangle") {
            const Vec3f a = vector(), b = vector(), c = vector();
            int material = 0;
            in >> material;
            shapes->mGeometry.push_back(new Triangle(a, b, c, material));
        } else if (kind == "ball") {
            const Vec3f center = vector();
            float radius = 0;
            int material = 0;
            in >> radius >> material;
            shapes->mGeometry.push_back(new Sphere(center, radius, material));
        } else if (kind == "lamp") {
            const Vec3f a = vector(), b = vector(), c = vector();
            auto* light = new AreaLight(a, b, c);
            light->mIntensity = vector();
            const int material = int(scene.mMaterials.size());
            scene.mMaterials.push_back(Material());
            shapes->mGeometry.push_back(new Triangle(a, b, c, material));
            scene.mMaterial2Light.insert(std::make_pair(material, lamps++));
            scene.mLights.push_back(light);
        } else if (kind == "point") {
            const Vec3f position = vector();
            auto* light = new PointLight(position);
            light->mIntensity = vector();
            scene.mLights.push_back(light);
            ++lamps;
        } else {
            throw std::runtime_error(path + (": unknown kind " + kind));
        }
    }
    scene.mSceneName = path;
    return true;
}
