import java.io.File;
import java.io.IOException;
import java.util.ArrayList;
import java.util.List;
import java.util.Map;
import org.eclipse.emf.common.util.URI;
import org.eclipse.emf.ecore.EObject;
import org.eclipse.emf.ecore.EPackage;
import org.eclipse.emf.ecore.resource.Resource;
import org.eclipse.emf.ecore.resource.ResourceSet;
import org.eclipse.emf.ecore.resource.impl.ResourceSetImpl;
import org.eclipse.emf.ecore.util.EcoreUtil;
import org.eclipse.emf.ecore.xmi.impl.EcoreResourceFactoryImpl;
import org.eclipse.emf.ecore.xmi.impl.XMIResourceFactoryImpl;

/** Loads metamodels and models and saves the models in their place, as Eclipse's editors do. */
public final class EmfSave {
  public static void main(String[] args) throws IOException {
    ResourceSet files = new ResourceSetImpl();
    var factories = files.getResourceFactoryRegistry().getExtensionToFactoryMap();
    factories.put("ecore", new EcoreResourceFactoryImpl());
    factories.put(Resource.Factory.Registry.DEFAULT_EXTENSION, new XMIResourceFactoryImpl());
    List<Resource> models = new ArrayList<>();
    for (String name : args) {
      Resource file = files.getResource(URI.createFileURI(new File(name).getCanonicalPath()), true);
      if (!name.endsWith(".ecore")) {
        models.add(file);
        continue;
      }
      for (EObject root : file.getContents()) {
        files.getPackageRegistry().put(((EPackage) root).getNsURI(), root);
      }
    }
    EcoreUtil.resolveAll(files);
    for (Resource model : models) {
      model.save(Map.of());
    }
  }
}
