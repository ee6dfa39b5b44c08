// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkSMTautlineMetricsDomain
 * @brief The metrics that a property may have: from the XML, and registered on the server.
 *
 * An enumeration whose further entries come from an information property, a line
 * "number<tab>label<tab>..." for each (vtkElementQuality::GetUserMetrics()). The list is read when
 * the proxy is created, so that a metric that was registered before is in the menu. The client
 * knows the facts of the metrics then, too, see mirrorUserMetrics(). In the XML it is an
 * EnumerationDomain, which MetricDomains.h replaces in the client:
 *
 *     <EnumerationDomain name="enum">
 *       <Entry value="0" text="Inverse mean ratio"/>
 *       <RequiredProperties>
 *         <Property name="UserMetrics" function="List"/>
 *       </RequiredProperties>
 *     </EnumerationDomain>
 *
 * @sa MetricDomains.h, tautline/Quality/UserMetric.h
 */

#ifndef vtkSMTautlineMetricsDomain_h
#define vtkSMTautlineMetricsDomain_h

#include "vtkSMEnumerationDomain.h"

#include <string> // for AddMetrics

class vtkClientServerInterpreter;

class vtkSMTautlineMetricsDomain : public vtkSMEnumerationDomain
{
public:
  static vtkSMTautlineMetricsDomain* New();
  vtkTypeMacro(vtkSMTautlineMetricsDomain, vtkSMEnumerationDomain);

  /// Adds the entries of the information property that are not there yet.
  void Update(vtkSMProperty* requestingProperty) override;

  /// Lets ParaView find the class by its name.
  static void Register(vtkClientServerInterpreter* interpreter);

protected:
  vtkSMTautlineMetricsDomain() = default;
  ~vtkSMTautlineMetricsDomain() override = default;

  /// Asks for the metrics, as the property may get a value before the proxy exists on the server.
  int ReadXMLAttributes(vtkSMProperty* property, vtkPVXMLElement* element) override;

private:
  void AddMetrics(const std::string& list);
  vtkSMTautlineMetricsDomain(const vtkSMTautlineMetricsDomain&) = delete;
  void operator=(const vtkSMTautlineMetricsDomain&) = delete;
};

#endif
