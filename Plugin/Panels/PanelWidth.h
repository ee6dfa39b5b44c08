// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file PanelWidth.h
 * @brief Widens the dock of the Properties panel until its content fits.
 */

#ifndef tautline_PanelWidth_h
#define tautline_PanelWidth_h

class QScrollBar;
class QWidget;

namespace tautline
{

/**
 * @brief Widens the dock that contains a widget if the panel needs a horizontal scroll bar.
 *
 * The default width is less than ParaView's own section Display needs. Not more than half the
 * window; a dock that floats or is wide enough is left alone, and so is one that the user made
 * narrower after it was widened for this content.
 */
void fitDock(QWidget* widget);

/// The horizontal scroll bar of the panel that contains a widget, or null.
QScrollBar* horizontalScrollBar(QWidget* widget);

} // namespace tautline

#endif
