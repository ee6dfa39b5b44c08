// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file FuzzTargets.h
 * @brief The functions that the fuzzers call with arbitrary bytes.
 *
 * A target turns bytes into the input of one part of Tautline and checks the result. The same
 * functions are driven by libFuzzer (clang), by a seeded mutator (other compilers), and by the test
 * TestFuzzTargets, which runs all inputs in Testing/Fuzz/Corpus once.
 */
#ifndef tautline_FuzzTargets_h
#define tautline_FuzzTargets_h

#include <algorithm>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace tautline
{
/// One target. `run` throws std::exception when the result is wrong; a crash speaks for itself.
struct FuzzTarget
{
  const char* name;
  void (*run)(std::string_view bytes);
};

/// All targets: readers of mesh files, images, kernel, solvers.
const std::vector<FuzzTarget>& fuzzTargets();

/// The target of that name, or null.
const FuzzTarget* findFuzzTarget(const std::string& name);

/// The directory where targets write files: TAUTLINE_FUZZ_DIR, by default /tmp.
const std::string& fuzzFolder();

/// Throws std::logic_error that names the property unless it holds.
void expectThat(bool holds, const std::string& property);

/// Numbers from bytes; zeros after the end.
class ByteReader
{
public:
  explicit ByteReader(std::string_view bytes)
    : Bytes(bytes)
  {
  }
  template <class T>
  T next()
  {
    char value[sizeof(T)] = {};
    const std::size_t count = this->Bytes.copy(value, sizeof(T));
    this->Bytes.remove_prefix(count);
    T result;
    static_assert(std::is_trivially_copyable_v<T>);
    std::copy(value, value + sizeof(T), reinterpret_cast<char*>(&result));
    return result;
  }
  /// From 0 to count - 1.
  int choice(int count) { return this->next<unsigned char>() % count; }
  bool atEnd() const { return this->Bytes.empty(); }
  std::size_t left() const { return this->Bytes.size(); }

private:
  std::string_view Bytes;
};

// The targets. FuzzReaders.cxx:
void fuzzTetGen(std::string_view bytes);
void fuzzMedit(std::string_view bytes);
void fuzzGmsh(std::string_view bytes);
void fuzzOff(std::string_view bytes);
void fuzzAbaqus(std::string_view bytes);
void fuzzNastran(std::string_view bytes);
void fuzzMfem(std::string_view bytes);
void fuzzFoam(std::string_view bytes);
// FuzzImages.cxx:
void fuzzImage(std::string_view bytes);
void fuzzImageList(std::string_view bytes);
void fuzzSilhouette(std::string_view bytes);
// FuzzKernel.cxx:
void fuzzQuality(std::string_view bytes);
void fuzzMesh(std::string_view bytes);
void fuzzMove(std::string_view bytes);
// FuzzReconnection.cxx:
void fuzzReconnection(std::string_view bytes);
// FuzzSolvers.cxx:
void fuzzPetscOptions(std::string_view bytes);
}
#endif
