// Reads the file that each line of input names with assimp, and prints the nanoseconds that it took.
#include <assimp/Importer.hpp>
#include <assimp/scene.h>

#include <chrono>
#include <iostream>
#include <string>

int main() {
    for (std::string path; std::getline(std::cin, path);) {
        Assimp::Importer importer;
        auto start = std::chrono::steady_clock::now();
        const aiScene *scene = importer.ReadFile(path, 0);
        auto end = std::chrono::steady_clock::now();
        if (scene == nullptr) {
            std::cerr << path << ": " << std::string(importer.GetErrorString()).substr(0, 200) << std::endl;
            std::cout << "failed" << std::endl;
        } else {
            std::cout << std::chrono::duration_cast<std::chrono::nanoseconds>(end - start).count() << std::endl;
        }
    }
}
