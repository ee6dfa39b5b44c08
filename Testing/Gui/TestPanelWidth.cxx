// SPDX-License-Identifier: BSD-3-Clause
// The dock of the Properties panel is widened until a page fits: to the width that the page needs,
// not beyond half the window, and not again after the user has made it narrower.
#include "PanelWidth.h"

#include <QApplication>
#include <QDockWidget>
#include <QMainWindow>
#include <QScrollArea>
#include <QScrollBar>
#include <QVBoxLayout>

#include <cstdlib>
#include <iostream>

namespace
{
int failures = 0;

void check(bool holds, const char* what, int value)
{
  if (!holds)
  {
    ++failures;
    std::cerr << what << ": " << value << "\n";
  }
}
}

int main(int argc, char* argv[])
{
  constexpr int windowWidth = 1000, narrow = 150, margin = 100;
  constexpr int needed = 300, more = 400, tooMuch = 900; // of the page
  QApplication application(argc, argv);
  QMainWindow window;
  window.resize(windowWidth, windowWidth / 2);
  window.setCentralWidget(new QWidget);
  auto* dock = new QDockWidget;
  auto* area = new QScrollArea;
  auto* page = new QWidget;
  auto* field = new QWidget;
  (new QVBoxLayout(page))->addWidget(field);
  field->setMinimumSize(needed, 100);
  area->setWidget(page);
  area->setWidgetResizable(true);
  dock->setWidget(area);
  window.addDockWidget(Qt::LeftDockWidgetArea, dock);
  window.show();
  const auto resize = [&](int width)
  {
    window.resizeDocks({ dock }, { width }, Qt::Horizontal);
    QApplication::processEvents();
  };
  const auto need = [&](int width)
  {
    field->setMinimumSize(width, 100);
    QApplication::processEvents();
    tautline::fitDock(field);
    QApplication::processEvents();
  };
  QScrollBar* bar = tautline::horizontalScrollBar(field);
  check(bar == area->horizontalScrollBar(), "the bar is another one", 0);
  check(!tautline::horizontalScrollBar(&window), "a bar without an area", 0);

  resize(narrow);
  check(bar->maximum() > 0, "the page is not cut at first, hidden pixels", bar->maximum());
  need(needed);
  check(bar->maximum() == 0 && dock->width() >= needed, "the page is cut, width", dock->width());
  check(dock->width() < needed + margin, "wider than the page needs", dock->width());

  // The user's width stays, until a page needs more.
  resize(narrow);
  need(needed);
  check(dock->width() < needed, "the user's width is lost", dock->width());
  need(more);
  check(
    bar->maximum() == 0 && dock->width() >= more, "the wider page is cut, width", dock->width());
  need(tooMuch);
  check(dock->width() == windowWidth / 2, "not half of the window", dock->width());
  return failures ? EXIT_FAILURE : EXIT_SUCCESS;
}
