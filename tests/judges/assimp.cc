// Reads models with assimp and prints where their nodes are at given times, one JSON object for each line of input.
//
// Input: id, file, format, number of the take, its name and times with commas between them, with tabs between the fields.
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/version.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

std::string quoted(const std::string &text) {
    std::string out = "\"";
    for (unsigned char c : text) {
        if (c == '"' || c == '\\') {
            out += '\\';
            out += char(c);
        } else if (c < 0x20) {
            char code[8];
            std::snprintf(code, sizeof code, "\\u%04x", c);
            out += code;
        } else {
            out += char(c);
        }
    }
    return out + "\"";
}

std::string numbers(const aiVector3D &v) {
    if (!std::isfinite(v.x + v.y + v.z)) return "[NaN,NaN,NaN]";
    char text[96];
    std::snprintf(text, sizeof text, "[%.9g,%.9g,%.9g]", v.x, v.y, v.z);
    return text;
}

// Returns the index of the last key that is not after the time.
template <typename Key> unsigned before(const Key *keys, unsigned count, double time) {
    unsigned at = 0;
    while (at + 1 < count && keys[at + 1].mTime <= time) at++;
    return at;
}

template <typename Key> double share(const Key *keys, unsigned count, unsigned at, double time) {
    if (at + 1 >= count || time <= keys[at].mTime) return 0.0;
    double length = keys[at + 1].mTime - keys[at].mTime;
    return length > 0.0 ? (time - keys[at].mTime) / length : 0.0;
}

aiVector3D vector_at(const aiVectorKey *keys, unsigned count, double time, aiVector3D otherwise) {
    if (count == 0) return otherwise;
    unsigned at = before(keys, count, time);
    double part = share(keys, count, at, time);
    if (part == 0.0) return keys[at].mValue;
    return keys[at].mValue + (keys[at + 1].mValue - keys[at].mValue) * float(part);
}

aiQuaternion rotation_at(const aiQuatKey *keys, unsigned count, double time, aiQuaternion otherwise) {
    if (count == 0) return otherwise;
    unsigned at = before(keys, count, time);
    double part = share(keys, count, at, time);
    if (part == 0.0) return keys[at].mValue;
    aiQuaternion out;
    aiQuaternion::Interpolate(out, keys[at].mValue, keys[at + 1].mValue, float(part));
    return out.Normalize();
}

using Channels = std::map<std::string, const aiNodeAnim *>;

void place(const aiNode *node, const aiMatrix4x4 &parent, const Channels &channels, double ticks, std::string &out) {
    aiMatrix4x4 local = node->mTransformation;
    auto found = channels.find(node->mName.C_Str());
    if (found != channels.end()) {
        const aiNodeAnim *keys = found->second;
        aiVector3D position, scale;
        aiQuaternion rotation;
        local.Decompose(scale, rotation, position);
        position = vector_at(keys->mPositionKeys, keys->mNumPositionKeys, ticks, position);
        rotation = rotation_at(keys->mRotationKeys, keys->mNumRotationKeys, ticks, rotation);
        scale = vector_at(keys->mScalingKeys, keys->mNumScalingKeys, ticks, scale);
        // The constructor from all three multiplies in another order.
        local = aiMatrix4x4(rotation.GetMatrix());
        aiMatrix4x4 part;
        local = aiMatrix4x4::Translation(position, part) * local;
        local = local * aiMatrix4x4::Scaling(scale, part);
    }
    aiMatrix4x4 world = parent * local;
    if (!out.empty()) out += ",";
    out += "[" + quoted(node->mName.C_Str()) + "," + numbers(aiVector3D(world.a4, world.b4, world.c4)) + "]";
    for (unsigned i = 0; i < node->mNumChildren; i++) place(node->mChildren[i], world, channels, ticks, out);
}

void vertices(const aiScene *scene, const aiNode *node, const aiMatrix4x4 &parent, std::string &out) {
    aiMatrix4x4 world = parent * node->mTransformation;
    for (unsigned i = 0; i < node->mNumMeshes; i++) {
        const aiMesh *mesh = scene->mMeshes[node->mMeshes[i]];
        for (unsigned vertex = 0; vertex < mesh->mNumVertices; vertex++) {
            if (!out.empty()) out += ",";
            out += numbers(world * mesh->mVertices[vertex]);
        }
    }
    for (unsigned i = 0; i < node->mNumChildren; i++) vertices(scene, node->mChildren[i], world, out);
}

void judge(const std::vector<std::string> &field) {
    Assimp::Importer importer;
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    std::string start = "{\"id\":" + quoted(field[0]);
    const aiScene *scene = importer.ReadFile(field[1], 0);
    if (scene == nullptr || scene->mRootNode == nullptr) {
        std::cout << start << ",\"error\":" << quoted(importer.GetErrorString()) << "}" << std::endl;
        return;
    }
    if (field[2] == "obj") {
        std::string all;
        vertices(scene, scene->mRootNode, aiMatrix4x4(), all);
        std::cout << start << ",\"vertices\":[" << all << "]}" << std::endl;
        return;
    }
    int take = std::stoi(field[3]);
    Channels channels;
    double rate = 1.0;
    if (take >= 0) {
        // assimp leaves out animations without channels, so that the name decides where it is known.
        const aiAnimation *found = nullptr;
        for (unsigned i = 0; i < scene->mNumAnimations; i++) {
            if (field[4] == scene->mAnimations[i]->mName.C_Str()) found = scene->mAnimations[i];
        }
        // Takes of FBX always have names, and one of a single instant is left out.
        bool by_number = found == nullptr && field[2] != "fbx";
        if (by_number && unsigned(take) < scene->mNumAnimations) found = scene->mAnimations[take];
        if (found == nullptr) {
            std::cout << start << ",\"error\":\"the animation is missing\"}" << std::endl;
            return;
        }
        rate = found->mTicksPerSecond > 0.0 ? found->mTicksPerSecond : 25.0;
        for (unsigned i = 0; i < found->mNumChannels; i++) {
            channels[found->mChannels[i]->mNodeName.C_Str()] = found->mChannels[i];
        }
    }
    std::string poses;
    std::stringstream times(field[5]);
    // A take of FBX begins at 0, wherever its first key is.
    double begin = take >= 0 && field[2] == "fbx" ? std::stod(field[5]) : 0.0;
    for (std::string time; std::getline(times, time, ',');) {
        std::string bones;
        // The root of FBX is not in the file; a bone of its name is another node.
        const aiNode *root = scene->mRootNode;
        double ticks = (std::stod(time) - begin) * rate;
        if (field[2] == "fbx") {
            for (unsigned i = 0; i < root->mNumChildren; i++) {
                place(root->mChildren[i], root->mTransformation, channels, ticks, bones);
            }
        } else {
            place(root, aiMatrix4x4(), channels, ticks, bones);
        }
        poses += (poses.empty() ? "[" : ",[") + bones + "]";
    }
    std::cout << start << ",\"poses\":[" << poses << "]}" << std::endl;
}

} // namespace

int main(int count, char **arguments) {
    if (count > 1 && std::string(arguments[1]) == "--version") {
        std::cout << aiGetVersionMajor() << "." << aiGetVersionMinor() << "." << aiGetVersionPatch() << std::endl;
        return 0;
    }
    for (std::string line; std::getline(std::cin, line);) {
        std::vector<std::string> field;
        std::stringstream fields(line);
        for (std::string part; std::getline(fields, part, '\t');) field.push_back(part);
        if (field.size() == 6) judge(field);
    }
    return 0;
}
