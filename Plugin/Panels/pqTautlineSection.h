// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class pqTautlineSection
 * @brief Puts the properties of a group into a section of the panel that is closed at first.
 *
 * A button with the name of the section opens and closes it. It is shown where any property of the
 * section applies, see the other hints of the properties. While the user searches the panel, all
 * sections are open. A section that was opened stays so for this kind of filter until ParaView
 * ends.
 *
 * The hint `<PropertyWidgetDecorator type="tautline_section" text="Stop"/>` of a group of
 * properties selects it, see Section.xml. The text is the label of the group; ParaView's own title
 * of the group is removed.
 */

#ifndef pqTautlineSection_h
#define pqTautlineSection_h

#include "pqPropertyWidgetDecorator.h"

#include <QPointer>

namespace tautline
{
class SectionHeader;
}

class pqTautlineSection : public pqPropertyWidgetDecorator
{
  Q_OBJECT

public:
  pqTautlineSection(vtkPVXMLElement* hint, pqPropertyWidget* field);
  ~pqTautlineSection() override;

  bool canShowWidget(bool showAdvanced) const override;

private:
  QPointer<tautline::SectionHeader> Header;
};

#endif
