// SPDX-License-Identifier: BSD-3-Clause
#include "Mutator.h"

#include "Readers/MeshFileChecks.h"

#include <chrono>
#include <filesystem>

namespace tautline
{
//------------------------------------------------------------------------------
std::vector<std::string> readCorpus(const std::string& folder)
{
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
  {
    if (entry.is_regular_file())
    {
      names.push_back(entry.path().string());
    }
  }
  std::sort(names.begin(), names.end());
  std::vector<std::string> contents;
  for (const std::string& name : names)
  {
    contents.push_back(readText(name));
  }
  return contents;
}

//------------------------------------------------------------------------------
void mutate(std::string& bytes, std::mt19937& random)
{
  const char* const words[] = { "-1", "0", "4294967296", "9223372036854775807", "1e308", "nan", "#",
    "\"", "$Nodes", "End", "\n", " ", "$EndElements", "Triangles", "1000000", "\n@node\n", "," };
  const auto below = [&](std::size_t n) { return n ? random() % n : 0; };
  const std::size_t at = below(bytes.size() + 1), length = 1 + below(12);
  switch (random() % 7)
  {
    case 0:
      bytes.resize(at);
      break;
    case 1:
      bytes.erase(at, length);
      break;
    case 2:
      bytes.insert(at, words[below(std::size(words))]);
      break;
    case 3:
      bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(200)));
      break;
    case 4: // another digit
      for (std::size_t i = at; i < bytes.size(); ++i)
      {
        if (bytes[i] >= '0' && bytes[i] <= '9')
        {
          bytes[i] = static_cast<char>('0' + random() % 10);
          break;
        }
      }
      break;
    case 5:
      bytes.replace(at, std::min(length, bytes.size() - at), words[below(std::size(words))]);
      break;
    default:
      for (std::size_t i = at; i < std::min(bytes.size(), at + length); ++i)
      {
        bytes[i] = static_cast<char>(random());
      }
  }
}

//------------------------------------------------------------------------------
long runTarget(const FuzzTarget& target, const std::vector<std::string>& corpus, double seconds,
  unsigned seed, const std::string& input, long most)
{
  long runs = 0;
  const auto run = [&](const std::string& bytes)
  {
    writeText(input, bytes);
    target.run(bytes);
    ++runs;
  };
  for (const std::string& bytes : corpus)
  {
    run(bytes);
  }
  constexpr std::size_t LongestInput = 1 << 16;
  std::mt19937 random(seed);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!corpus.empty() && (most < 0 || runs < most) && std::chrono::steady_clock::now() < end)
  {
    std::string bytes = corpus[random() % corpus.size()];
    for (auto times = 1 + random() % 4; times > 0; --times)
    {
      mutate(bytes, random);
    }
    bytes.resize(std::min(bytes.size(), LongestInput));
    run(bytes);
  }
  return runs;
}
}
